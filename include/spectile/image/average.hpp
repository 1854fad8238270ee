// Averages of whole images: independent renders of one frame become one with less noise.
#pragma once

#include <optional>
#include <span>
#include <spectile/image/image.hpp>
#include <spectile/result.hpp>
#include <string>
#include <vector>

namespace spectile {

/// Options of average_images(). With NonFinite::kZero, a sample that is not finite is left out of its
/// channel's average at its pixel, and the others' weights count for all; where every image's is, 0 is
/// written.
struct AverageOptions : ImageOptions {
  std::vector<double> weights;       ///< one an image, from 0 on; empty: all are equal
  std::optional<SampleType> stored;  ///< the widest type of the images' where none; `pixel` does not matter
};

/// Averages images of one frame, channel by channel: sum of weight * sample over sum of weights. The sums are
/// exact and the average is rounded once, so neither the images' order nor a factor common to all weights
/// changes a bit of the samples. Attributes are those of the first image, but for those that describe its
/// pixels; `spectileAverage` says how many images there were, and the sum of their weights.
/// Shapes: all images have the same display window, channels, none subsampled, and parts, whose order may
/// differ; each part is averaged by itself. Where data windows differ the average has the least that holds
/// them all: a pixel is the average of the images that cover it, 0 where none does. Channels that name
/// objects, uint or of a Cryptomatte, are not averaged but the first image's. Notes say so. An image of
/// weight 0 gives its header alone: its samples are not read. Units: the images', which must be the same:
/// colour space, exposure value (EV), emissiveUnits, filters. Weights have none; samples a pixel, say.
/// Errors: kBadArgument for no images, weights of another number than these, negative, not finite, all 0, or
/// too far apart to be summed exactly (beyond about 2^40), and an output that is an input; kBadFile for
/// images that differ, which names both and what differs; kNonFinite, with the image, its first such pixel
/// and their number.
Result<ImageReport> average_images(std::span<const std::string> inputs, const std::string& output,
                                   const AverageOptions& options = {});

}  // namespace spectile
