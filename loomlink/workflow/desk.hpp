#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>
#include <weave/net/throttle.hpp>

#include <chrono>
#include <functional>
#include <loomlink/keys/key.hpp>
#include <loomlink/keys/password.hpp>
#include <loomlink/keys/utc.hpp>
#include <loomlink/store/store.hpp>
#include <loomlink/workflow/caller.hpp>
#include <loomlink/workflow/denial.hpp>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace weave::loomlink {

/// What tells the time.
using NowClock = std::function<Instant()>;
NowClock system_clock();

struct DeskSettings {
    GuessCost key_cost = loomlink::key_cost();      ///< of the keys of people
    GuessCost login_cost = loomlink::login_cost();  ///< of log-ins
    std::chrono::minutes session{30};               ///< without a call, then it ends
    std::chrono::hours invitation{7 * 24};
    /// Wrong passwords: per name, and per address.
    net::ThrottleRate by_name{5, 1.0 / 60, 10000}, by_address{60, 0.5, 10000};
    std::chrono::minutes view_again{10};  ///< the same look by the same person is logged once in so long
};

/// The server's own keys.
struct ServerKeys {
    KeyPair log, stamp;
};

/// A step that is about to be taken: what the log will say of it.
struct Deed {
    std::string kind;     ///< such as `revision.approved`
    std::string subject;  ///< what it is done to; may be empty
    std::string reason;
    Json data = Json::object();
    bool is_signed = false;
    bool told_once = false;  ///< the answer holds a secret: it is not kept, a repetition is refused
    /// What the same password signs beside the statement.
    std::vector<std::pair<Purpose, std::string>> also{};
};

/// A step that is being stored.
struct TakenStep {
    Seq event = 0;
    std::string at;               ///< the moment that the record tells
    std::vector<Signature> also;  ///< of Deed::also
};

/// What all subjects of the workflow work with: the store, the clock, the keys; and the one way in which a
/// step is taken. Safe to use from any thread.
class Desk {
  public:
    using Check = std::function<Status(const Reader&, const Caller&)>;
    using Apply = std::function<Result<Json>(Writer&, const TakenStep&)>;

    Desk(Store store, ServerKeys keys, std::string site, DeskSettings settings, NowClock clock);

    [[nodiscard]] Store& store() { return m_store; }
    [[nodiscard]] const ServerKeys& keys() const { return m_keys; }
    [[nodiscard]] const std::string& site() const { return m_site; }
    [[nodiscard]] const DeskSettings& settings() const { return m_settings; }
    [[nodiscard]] const PasswordHasher& hasher() const { return m_hasher; }
    [[nodiscard]] Instant now() const { return m_clock(); }
    [[nodiscard]] std::string now_text() const { return utc_text(now()); }

    /// Takes a step: `check` says whether it may be (asked before the password is tried, and again in the
    /// transaction), then the statement is signed where it has to be, and record, change and answer are
    /// stored together. `check` gets the caller as the store knows the person now. A repeated request id is
    /// given the answer of the first time. What is refused is logged as `refused` and changes nothing.
    Result<Json> take(const Caller& caller, const Ask& ask, const Deed& deed, const Check& check,
                      const Apply& apply);

    /// The answer that a request id was given before. Refused: it was for another step.
    Result<std::optional<Json>> recorded(const Caller& caller, const std::string& request, const Deed& deed);

    /// Signatures of the person's own key, opened with the password typed for this step alone. Refused and
    /// counted where it is wrong; after too many nobody can try for a while.
    Result<std::vector<Signature>> sign_all(const Caller& caller, const std::string& password,
                                            const std::vector<std::pair<Purpose, std::string>>& messages);

    /// Logs that something was not done, and gives the error back.
    Error refuse(const std::string& actor, const std::string& request, const Deed& deed, Error error);
    /// Logs that a person looked at something, once in a while for the same look.
    Status note_view(const Caller& caller, const std::string& kind, const std::string& subject,
                     const Json& data = Json::object());
    /// Logs one thing that is done by itself.
    Status note(const std::string& actor, const std::string& kind, const std::string& subject,
                const Json& data = Json::object());

    /// One try of a name, of an address, or of both (empty: not of it), that may be wrong.
    Status count_try(const std::string& name, const std::string& address);
    /// Forgets the tries of a name after one that was right; those of its address stay counted.
    void forgive(const std::string& name);

    [[nodiscard]] Statement statement_of(const std::string& actor, const std::string& request,
                                         const Deed& deed) const;

  private:
    Result<Json> take_allowed(const Caller& caller, const Ask& ask, const Deed& deed, const Check& check,
                              const Apply& apply);
    [[nodiscard]] net::Throttle::Clock::time_point throttle_now() const;

    Store m_store;
    ServerKeys m_keys;
    std::string m_site;
    DeskSettings m_settings;
    NowClock m_clock;
    PasswordHasher m_hasher;
    net::Throttle m_names, m_addresses;
    std::mutex m_views_mutex;
    std::map<std::string, Instant> m_views;
};

/// The person as the store knows him or her now. Refused: who was disabled since.
Result<Caller> fresh_caller(const Reader& reader, const Caller& caller);

/// The key of a person that signs now: the newest with a secret that was not revoked.
Result<PersonKey> signing_key(const Reader& reader, Id person);

/// Texts that people give: UTF-8 without control characters but line feed and tab, `least` to `most` bytes.
Status check_text(const std::string& text, const std::string& member, std::size_t least, std::size_t most);
/// Names of designs, looms and branches: 1 to 64 letters, digits, `.`, `-`, `_` and (but in designs) single
/// spaces within.
Status check_name(const std::string& name, const std::string& member, bool spaces);

}  // namespace weave::loomlink
