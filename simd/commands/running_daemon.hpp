#pragma once

#include <weave/command/service_places.hpp>
#include <weave/core/json.hpp>
#include <weave/core/result.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <simd/commands/config.hpp>

namespace weave::simd {

/// Where things lie in the folder of a daemon.
struct DaemonFolder {
    std::filesystem::path path;
    [[nodiscard]] std::filesystem::path store() const { return path / "simd.db"; }
    [[nodiscard]] std::filesystem::path tokens() const { return path / "tokens"; }
    [[nodiscard]] std::filesystem::path socket() const { return path / "simd.sock"; }
    [[nodiscard]] net::TlsFiles tls() const { return {path / "tls.pem", path / "tls.key"}; }
};

/// Whether what the configuration names is there and usable, and can be listened on. Errors name the member.
Status check_places(const DaemonFolder& folder, const ServeConfig& config);

/// A daemon with its service. Ends with the object, at once; stop() before that puts everything away.
class RunningDaemon {
  public:
    /// Opens or makes the folder, takes up what it holds, and serves. `program` is this program, for its workers.
    static Result<std::unique_ptr<RunningDaemon>> start(const DaemonFolder& folder, const ServeConfig& config, const std::filesystem::path& program);
    ~RunningDaemon();
    RunningDaemon(const RunningDaemon&) = delete;
    RunningDaemon& operator=(const RunningDaemon&) = delete;

    [[nodiscard]] std::uint16_t port() const;
    /// How to reach it: `url` and `certificate_sha256` where it serves TCP, `unix_socket`, `threads`, `memory_bytes`.
    [[nodiscard]] Json introduction() const;
    void stop();

  private:
    struct Parts;
    explicit RunningDaemon(std::unique_ptr<Parts> parts);
    std::unique_ptr<Parts> m_parts;
};

}  // namespace weave::simd
