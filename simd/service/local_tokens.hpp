#pragma once

#include <weave/core/result.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace weave::simd {

/// Tokens for a machine without loomlink: a private file, each line a name and the SHA-256 of a token. Whoever reads it can
/// come in as nobody.

/// A new token for this name, in place of an earlier one. Told once; the file keeps its hash. Errors: a name that is none.
Result<std::string> add_local_token(const std::filesystem::path& file, const std::string& person);
/// Refused: there is none of this name.
Status remove_local_token(const std::filesystem::path& file, const std::string& person);
/// The same of the text of such a file. Errors name the line.
Result<std::map<std::string, std::string>> parse_local_tokens(std::string_view text);
/// Names by the hashes of their tokens; none where there is no file. Errors: a file that others may read, a broken line.
Result<std::map<std::string, std::string>> read_local_tokens(const std::filesystem::path& file);

}  // namespace weave::simd
