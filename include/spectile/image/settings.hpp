// Settings: what shapes an image that is written, as one line of text in the image itself.
#pragma once

#include <span>
#include <spectile/image/convert.hpp>
#include <spectile/image/image.hpp>
#include <spectile/result.hpp>
#include <string>
#include <string_view>

namespace spectile {

/// Everything about a conversion but its input that shapes what is written, with the library's version: one
/// line, the same for the same settings, different for different ones. Lights, bands and spaces are told
/// apart by a digest (64 bits) of their numbers. Threads, lanes a call, instruction set and progress are not
/// in it: they change no bit. Images written by these functions carry it as the attribute spectileSettings.
std::string settings_text(const UpsampleImageOptions& options);
std::string settings_text(const RelightImageOptions& options);
std::string settings_text(const ProjectImageOptions& options);
std::string settings_text(const ExpandImageOptions& options);
std::string settings_text(const ConvertImageOptions& options);

/// The settings that an image says it was made with; empty where it does not say. Errors: kBadFile,
/// kNoPermission.
Result<std::string> settings_of(const std::string& path);

/// True if an output needs no new conversion: it is a whole image, made with these settings, and was last
/// written after each of the files that it was made from. Times that are equal do not count, nor does a file
/// that cannot be looked at: where there is doubt, the answer is no.
bool up_to_date(const std::string& output, std::span<const std::string> dependencies,
                std::string_view settings);

}  // namespace spectile
