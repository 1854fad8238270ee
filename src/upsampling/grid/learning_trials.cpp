// Evaluates learned nodes on reflectances that took no part.
#include <algorithm>
#include <set>
#include <spectile/spectra/named_spectra.hpp>
#include <spectile/upsampling/learned_nodes.hpp>
#include <spectile/upsampling/upsample.hpp>

#include "src/base/out_of_memory.hpp"
#include "src/upsampling/grid/measured_colors.hpp"

namespace spectile {
namespace {

constexpr std::size_t kFolds = 5;
constexpr const char* kLights[] = {"A", "FL2", "FL11", "LED-B3", "HP1"};
constexpr Method kCompared[] = {Method::kSigmoid, Method::kSigmoidObserver, Method::kTetrahedral};

/// Differences of reflectances and those that a method makes of their RGB, under each light.
class Evaluation {
 public:
  static Result<Evaluation> create(const LearningOptions& options) {
    Evaluation out;
    SPECTILE_ASSIGN(auto colors, MeasuredColors::create(options));
    out.colors_.emplace(std::move(colors));
    for (const char* name : kLights) {
      SPECTILE_ASSIGN(const auto light, illuminant(name));
      SPECTILE_ASSIGN(auto projector, Projector::reflective(out.colors_->bands(), light, options.observer));
      out.lights_.push_back(std::move(projector));
    }
    out.upsampling_.observer = options.observer;
    if (options.light) out.upsampling_.light = options.light->spectrum;
    return out;
  }

  const Bands& bands() const { return colors_->bands(); }

  /// Those within the cube.
  std::vector<const Spectrum*> inside(const std::vector<const Spectrum*>& reflectances) const {
    std::vector<const Spectrum*> out;
    for (const Spectrum* r : reflectances) {
      const auto rgb = colors_->rgb_of(*r);
      if (std::all_of(rgb.begin(), rgb.end(), [](double v) { return v >= 0 && v <= 1; })) out.push_back(r);
    }
    return out;
  }

  Result<std::vector<double>> differences(Method method, const LearnedNodes* nodes,
                                          const std::vector<const Spectrum*>& reflectances) const {
    std::vector<double> out;
    if (reflectances.empty()) return out;
    UpsamplerOptions options = upsampling_;
    if (nodes != nullptr) options.nodes = std::make_shared<const LearnedNodes>(*nodes);
    SPECTILE_ASSIGN(const auto upsampler,
                    Upsampler::create(method, Quantity::kReflectance, colors_->bands(), options));
    SPECTILE_ASSIGN(auto rgb, ColorLanes::create(reflectances.size()));
    for (std::size_t i = 0; i < reflectances.size(); ++i) {
      const auto color = colors_->rgb_of(*reflectances[i]);
      for (std::size_t k = 0; k < 3; ++k) rgb.at(i, k) = static_cast<float>(color[k]);
    }
    SPECTILE_ASSIGN(auto spectra, SampledSpectra::create(colors_->bands(), reflectances.size()));
    SPECTILE_TRY(upsample_srgb(upsampler, rgb.view(), spectra.span()));
    for (std::size_t i = 0; i < reflectances.size(); ++i) {
      const std::vector<float> measured = reflectances[i]->average_over(colors_->bands());
      for (const Projector& light : lights_) {
        std::array<double, 3> want{};
        std::array<double, 3> got{};
        for (std::size_t b = 0; b < measured.size(); ++b) {
          for (std::size_t k = 0; k < 3; ++k) {
            want[k] += light.weights()[b][k] * static_cast<double>(measured[b]);
            got[k] += light.weights()[b][k] * static_cast<double>(spectra.at(i, b));
          }
        }
        out.push_back(ciede2000(xyz_to_lab(want, light.white()), xyz_to_lab(got, light.white())));
      }
    }
    return out;
  }

 private:
  std::optional<MeasuredColors> colors_;
  std::vector<Projector> lights_;
  UpsamplerOptions upsampling_;
};

/// Reflectances apart by a rule: those that are held out, and those that are learned from, without what is
/// also among the others.
struct Split {
  std::vector<ReflectanceSet> learned;
  std::vector<const Spectrum*> held_out;
  std::size_t count = 0;  ///< of those learned from
};

/// `is_held_out`: of set s, reflectance i.
template <class IsHeldOut>
Split split_by(std::span<const ReflectanceSet> sets, const Bands& bands, IsHeldOut is_held_out) {
  Split out;
  std::set<std::vector<float>> known;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    for (std::size_t i = 0; i < sets[s].reflectances.size(); ++i) {
      const Spectrum& r = sets[s].reflectances[i];
      if (is_held_out(s, i) && known.insert(r.average_over(bands)).second) out.held_out.push_back(&r);
    }
  }
  for (std::size_t s = 0; s < sets.size(); ++s) {
    ReflectanceSet& learned = out.learned.emplace_back();
    for (std::size_t i = 0; i < sets[s].reflectances.size(); ++i) {
      const Spectrum& r = sets[s].reflectances[i];
      if (!is_held_out(s, i) && !known.contains(r.average_over(bands))) learned.reflectances.push_back(r);
    }
    out.count += learned.reflectances.size();
  }
  return out;
}

/// Adds the differences of one split to what there is of each method, the learned one last.
Result<void> add_split(const Evaluation& evaluation, const Split& split, const LearningOptions& options,
                       std::array<std::vector<double>, 4>& to) {
  SPECTILE_ASSIGN(const auto nodes, learn_from(split.learned, options));
  const auto inside = evaluation.inside(split.held_out);
  for (std::size_t m = 0; m < 4; ++m) {
    const bool learned = m == std::size(kCompared);
    SPECTILE_ASSIGN(const auto found, evaluation.differences(learned ? Method::kTetrahedral : kCompared[m],
                                                             learned ? &nodes : nullptr, inside));
    to[m].insert(to[m].end(), found.begin(), found.end());
  }
  return {};
}

LearningTrial trial_of(std::string name, std::array<std::vector<double>, 4> differences) {
  LearningTrial out;
  out.held_out = std::move(name);
  out.reflectances = differences[0].size() / std::size(kLights);
  ColorError* const errors[] = {&out.sigmoid, &out.sigmoid_observer, &out.tetrahedral, &out.learned};
  for (std::size_t m = 0; m < 4; ++m) *errors[m] = summarize(std::move(differences[m]));
  return out;
}

Result<std::vector<LearningTrial>> try_all(std::span<const ReflectanceSet> sets,
                                           const LearningOptions& options) {
  std::vector<LearningTrial> out;
  SPECTILE_ASSIGN(const auto evaluation, Evaluation::create(options));
  std::array<std::vector<double>, 4> folded;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    const Split split = split_by(sets, evaluation.bands(), [=](std::size_t s, std::size_t i) {
      return i * kFolds / sets[s].reflectances.size() == fold;
    });
    if (split.count > 0) SPECTILE_TRY(add_split(evaluation, split, options, folded));
  }
  out.push_back(trial_of({}, std::move(folded)));
  for (std::size_t s = 0; sets.size() > 1 && s < sets.size(); ++s) {
    const Split split =
        split_by(sets, evaluation.bands(), [=](std::size_t set, std::size_t) { return set == s; });
    std::array<std::vector<double>, 4> differences;
    if (split.count >= kMinReflectances) SPECTILE_TRY(add_split(evaluation, split, options, differences));
    out.push_back(trial_of(sets[s].name, std::move(differences)));
    out.back().learned_from = split.count;
  }
  return out;
}

}  // namespace

bool LearningTrial::pays() const {
  return learned.mean < std::min({sigmoid.mean, sigmoid_observer.mean, tetrahedral.mean});
}

Result<std::vector<LearningTrial>> try_learning(std::span<const ReflectanceSet> sets,
                                                const LearningOptions& options) {
  SPECTILE_TRY(check_sizes(sets));
  return guard_memory([&] { return try_all(sets, options); }, "no memory to evaluate learned nodes");
}

}  // namespace spectile
