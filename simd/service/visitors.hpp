#pragma once

#include <weave/core/result.hpp>
#include <weave/keys/key.hpp>
#include <weave/net/message.hpp>
#include <weave/net/throttle.hpp>

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace weave::simd {

/// Who sent a request.
struct Visitor {
    std::string person;
    std::function<bool()> may_stay;  ///< whether the token counts still; null: it needs none. No longer than the doorkeeper lives
    bool is_local = false;  ///< over the Unix socket: the owner of the machine
};

/// Whose tokens count.
struct TokenRules {
    std::string site;              ///< of the loomlink whose tokens count; empty: any with a key below
    std::vector<PublicKey> keys;   ///< its public keys
    std::filesystem::path file;    ///< local tokens (local_tokens.hpp); missing: none
};

/// Lets in whoever shows a token, or came over the Unix socket. Safe from any thread.
class Doorkeeper {
  public:
    explicit Doorkeeper(TokenRules rules) : m_rules(std::move(rules)) {}

    /// Refused, in the same words whatever is wrong with a token: no stranger learns more than that it does not count.
    Result<Visitor> let_in(const net::Request& request);
    /// A connection of this person was closed because it cost others their time. Who is thrown out for the second time within
    /// ten seconds waits before the next connection: making one costs the machine more than a message does.
    void thrown_out(const std::string& person) { static_cast<void>(m_thrown_out.take(person)); }
    /// For how long that is; 0: not at all.
    [[nodiscard]] std::chrono::seconds wait(const std::string& person) { return m_thrown_out.wait(person); }

  private:
    std::optional<Visitor> visitor_of(const std::string& token);
    std::optional<std::string> local_person(const std::string& hash);
    void read_file();

    TokenRules m_rules;
    std::mutex m_mutex;
    std::map<std::string, std::string> m_people;  ///< by the hash of their local token
    std::filesystem::file_time_type m_read{};
    net::Throttle m_wrong{{20, 0.2, 10000}};      ///< tokens that did not count, by address
    net::Throttle m_thrown_out{{2, 0.1, 10000}};  ///< connections, by person
};

/// The person of requests over the Unix socket; no token may name it.
inline constexpr const char* local_person_name = "local";

}  // namespace weave::simd
