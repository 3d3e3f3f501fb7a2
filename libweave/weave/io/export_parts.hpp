#pragma once

#include <weave/core/json.hpp>
#include <weave/io/bitmap.hpp>
#include <weave/loom/profile.hpp>

#include <string>

/// What a sample and a release have in common: the picture of the card and how a manifest speaks of it.
namespace weave {

/// A file name that every mill's system takes: letters, digits, `-` and `_`, all else as `-`; 1 to 100
/// characters.
std::string plain_name(const std::string& stem);

/// The kind of picture for a loom: its own where it takes one; beside a controller's file a PNG to look at.
BitmapFormat picture_format(const LoomProfile& profile);

/// How that picture stands for the card: as the profile says where the loom takes it, else in our own way.
BitmapReading picture_reading(const LoomProfile& profile);

/// `png`, `tiff`, `bmp`, and what their file names end in.
const char* name_of(BitmapFormat format);
const char* extension_of(BitmapFormat format);

/// What a manifest says of a picture: which colour and which stored bit lifts, where pick 1 and end 1 stand,
/// the order of bits, and from which face the card is seen.
Json reading_entry(const BitmapReading& reading, BitmapFormat format);

/// What a manifest says of the loom: name, maker, `revision`, and `sha256` of the profile's canonical bytes.
Json loom_entry(const LoomProfile& profile);

}  // namespace weave
