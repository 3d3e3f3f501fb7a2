#pragma once

#include "service_program.hpp"

#include <weave/design/design.hpp>
#include <weave/wire/client.hpp>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <stdexcept>
#include <sys/types.h>
#include <vector>

namespace weave::bench {

/// The program `simd`, which lies beside this one, serving a folder of its own as it is shipped: over plain loopback to people
/// with tokens, and over its Unix socket. What goes wrong is an exception.
class SimdBox {
  public:
    /// `threads` that compute; 0: one a core. So many people have a token: `person-0` …
    explicit SimdBox(std::size_t threads, std::size_t people = 0);

    /// As a fault of the machine ends it.
    void kill();
    void start();

    /// As the machine's owner, over the Unix socket.
    [[nodiscard]] wire::ServerPlace place() const;
    /// As one of the people, over TCP.
    [[nodiscard]] wire::ServerPlace place_of_person(std::size_t person) const;
    [[nodiscard]] Json status() const;
    /// What the status says of a session.
    [[nodiscard]] Json session(std::uint64_t number) const;
    /// The worker of a session; nothing while it has none.
    [[nodiscard]] std::optional<pid_t> worker(std::uint64_t session) const;
    /// Age of the state that a session's checkpoint file holds; nothing where there is none.
    [[nodiscard]] std::optional<double> checkpoint_age_s(std::uint64_t session) const;
    /// Seconds of processor that the daemon itself has had, without its workers.
    [[nodiscard]] double cpu_s() const;

  private:
    WorkFolder m_folder;
    std::vector<std::string> m_tokens;
    std::optional<ServiceProgram> m_program;
};

/// Angle interlock B tiled to about so many control points at fidelity standard.
struct TiledCloth {
    std::string document;
    std::size_t points = 0;  ///< that it has
};
TiledCloth tiled_cloth(std::size_t points);

/// The whole cloth of a document, at a residual that it never reaches.
wire::Simulation restless();

/// Parameters that a restless cloth is led to by turns.
wire::Parameters parameters_of_turn(std::size_t turn);

/// Where and when something is measured: `processor`, `cores`, `at`, and the load of the machine then.
Json circumstances();
/// The same for people.
std::string told_circumstances(const Json& before, const Json& after);

/// The value of a result that must be one.
template <class T>
T must(Result<T> result, const char* what) {
    if (!result) throw std::runtime_error(std::string(what) + ": " + result.error().text());
    return std::move(*result);
}
void must(const Status& status, const char* what);

}  // namespace weave::bench
