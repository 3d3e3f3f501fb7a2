#pragma once

#include <weave/design/design.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace weave {

/// The version of the `.weave` format that this library writes; it reads this one and all before it.
inline constexpr int document_version = 1;

/// A design as a `.weave` document (specification: FORMAT.md beside this file). Reading what write_document
/// made gives an equal design, and writing it again the same bytes.
std::string write_document(const Design& design);

/// Refused: what begins as a file of another kind does, which is told for what it is.
Status check_beginning(std::string_view text);

/// Reads a `.weave` document and checks it (see check()). Errors name the place, such as
/// `blocks.toe.stacks[3][4]`; a file of another kind is told for what it is.
Result<Design> read_document(std::string_view text);

/// The same from and to a file; errors name it. Saving replaces the file whole or leaves it as it was.
Result<Design> load_design(const std::filesystem::path& path);
Status save_design(const Design& design, const std::filesystem::path& path);

/// Hash of the canonical bytes of the design without its scene and view, and of its scene alone.
std::string design_sha256(const Design& design);
std::string scene_sha256(const Design& design);

}  // namespace weave
