// Places for the labels of a chart's marks: beside them, over nothing.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace spectile::report {

struct Box {
  double left = 0, top = 0, right = 0, bottom = 0;
};
bool overlap(const Box& a, const Box& b);

struct Label {
  double x = 0, y = 0;  ///< of the text's anchor, on its base line
  const char* anchor = "start";
  std::string text;
  bool leader = false;  ///< too far from its mark to go without a line
  double leader_x = 0, leader_y = 0;
};

/// Occupied and free places for text.
class LabelPlaces {
 public:
  enum class LabelDistance {
    kBeside,  ///< at the mark, where need be over what is to be avoided
    kClear,   ///< at the mark or, with a line to it, a little away; over nothing
  };

  LabelPlaces(const Box& inside, double font_size) : inside_(inside), font_size_(font_size) {}

  void occupy(const Box& box) { taken_.push_back(box); }
  /// To be avoided, not forbidden: a line, as boxes along it.
  void avoid(const Box& box) { avoided_.push_back(box); }

  /// A place for text by a mark. Nothing where there is none.
  std::optional<Label> place(double x, double y, double radius, const std::string& text,
                             LabelDistance distance);

 private:
  Box inside_;
  double font_size_;
  std::vector<Box> taken_, avoided_;
};

/// Width of text in a sans-serif font, rather too large than too small.
double text_width(const std::string& text, double font_size);

}  // namespace spectile::report
