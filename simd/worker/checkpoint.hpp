#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace weave::simd {

/// What a run is between two legs, to be taken up by another process.
struct Checkpoint {
    std::uint64_t step = 0;
    std::uint64_t changes = 0;            ///< of the journal that it has had
    Json run;                             ///< sim::Run::state()
};

/// Where it lies in the folder of a session or job.
std::filesystem::path checkpoint_path(const std::filesystem::path& folder);

/// Writes it, whole or not at all: a line that names the format, the SHA-256 of the rest, the rest as CBOR (RFC 8949).
Status write_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint);

/// The checkpoint that these bytes of a file are. Errors: bytes that were damaged, or are of another version.
Result<Checkpoint> parse_checkpoint(std::string_view bytes);

/// The checkpoint of a folder; nothing where there is none. Errors: one that was damaged, or is of another version.
Result<std::optional<Checkpoint>> read_checkpoint(const std::filesystem::path& folder);

}  // namespace weave::simd
