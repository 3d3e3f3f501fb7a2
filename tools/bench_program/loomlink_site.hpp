#pragma once

#include "service_program.hpp"

#include <weave/core/json.hpp>
#include <weave/net/client.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace weave::bench {

/// The program `loomlink`, which lies beside this one, serving a site in a folder of its own over TLS on
/// loopback, as it is shipped. What goes wrong is an exception: a benchmark has nothing to go on with.
class LoomlinkSite {
  public:
    LoomlinkSite();

    /// A person who has joined, with a connection of his or her own. For one thread at a time.
    class Person {
      public:
        Person(const net::ClientOptions& options, std::string token)
            : m_client(options), m_token(std::move(token)) {}
        /// Asks below /api/v1; a change gets a request id.
        Result<net::Response> ask(const std::string& method, const std::string& path, Json body = {});
        /// The answer of what must succeed.
        Json done(const std::string& method, const std::string& path, const Json& body = {});

      private:
        net::HttpClient m_client;
        std::string m_token;
    };

    /// The administrator; with the policy that no simulation is needed.
    Person& administrator() { return m_people.front(); }
    /// Somebody new. Waits where the service says that too many came at once.
    Person join(const std::string& name, const std::string& role);

    /// Ends the program in good order, so that all lies in the one file, and tells how many bytes that has.
    std::uintmax_t stop_and_measure();
    /// Serves again.
    void start();
    /// The same person on a new connection, after start().
    [[nodiscard]] Person again(const std::string& name) const;

    static constexpr const char* password = "warp and weft and warp";

  private:
    Json spawn();
    [[nodiscard]] std::string accept(const std::string& code, const std::string& name) const;

    WorkFolder m_folder;
    std::optional<ServiceProgram> m_program;
    net::ClientOptions m_options;
    std::vector<Person> m_people;
    std::vector<std::pair<std::string, std::string>> m_tokens;
};

}  // namespace weave::bench
