#pragma once

#include <weave/command/service_config.hpp>
#include <weave/core/result.hpp>
#include <weave/keys/key.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace weave::simd {

/// How simd serves. An empty `address`: on the Unix socket alone.
struct ServeConfig : ServiceConfig {
    ServeConfig() {
        port = 8444;
        workers = 8;
    }
    std::filesystem::path unix_socket;   ///< `unix_socket`; none: `simd.sock` in the folder
    std::size_t threads = 0;             ///< `threads` that compute; 0: one a core
    std::string backend = "auto";        ///< `backend` that computes: auto, cpu or cuda
    std::uint64_t memory_bytes = 0;      ///< `memory_mib` for all sessions and jobs together; 0: four fifths of the machine's
    std::size_t sessions = 64;           ///< `sessions` in all
    std::size_t sessions_per_person = 16;  ///< `sessions_per_person`
    std::size_t jobs_at_once = 2;        ///< `jobs_at_once`
    std::size_t jobs_per_person = 1000;  ///< `jobs_per_person` that are not acknowledged
    std::int64_t expire_seconds = 86400;  ///< `expire_seconds`: a session to which nobody is attached for so long is ended
    std::int64_t stall_seconds = 300;    ///< `stall_seconds`: a worker that does not answer for so long is ended
    std::string site;                    ///< `site`: name of the loomlink whose tokens count
    std::vector<PublicKey> access_keys;  ///< `access_keys`: its public keys for tokens, in hexadecimal
    std::filesystem::path evidence_key;  ///< `evidence_key`: file of `loomlink signer enrol`; none: nothing is signed
};

/// Errors name the member: unknown ones too, and what no single member shows. Paths count from `folder`.
Result<ServeConfig> parse_config(std::string_view text, const std::filesystem::path& folder = {});
/// What no single member shows. Errors name a member.
Status check_config(const ServeConfig& config);

/// Threads and memory with what the machine has, where the configuration leaves that open.
std::size_t threads_of(const ServeConfig& config);
std::uint64_t memory_of(const ServeConfig& config);
/// What this machine has, bytes.
std::uint64_t machine_memory();

}  // namespace weave::simd
