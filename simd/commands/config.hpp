#pragma once

#include <weave/command/service_config.hpp>
#include <weave/core/result.hpp>
#include <weave/keys/key.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <simd/slurm/slurm.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace weave::simd {

/// `slurm`: that jobs go to Slurm, and how.
struct SlurmConfig {
    std::filesystem::path folder;      ///< `folder` that this machine and all nodes see under this name
    std::filesystem::path program;     ///< `program`: simd as nodes have it; none: as it lies here
    SlurmWishes wishes;                ///< `partition`, `account`, `qos`, `gres`, `cpus`, `memory_mib`, `minutes` of a job
    std::size_t jobs_at_once = 1000;   ///< `jobs_at_once` that Slurm has, at most 1000
    std::int64_t watch_seconds = 5;    ///< `watch_seconds` from one look at its queue to the next
    std::int64_t checkpoint_seconds = 120;  ///< `checkpoint_seconds` from one checkpoint to the next, as long as legs end
};

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
    std::optional<SlurmConfig> slurm;    ///< `slurm`; none: jobs are done on this machine
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
