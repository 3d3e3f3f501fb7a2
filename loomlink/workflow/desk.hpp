#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>
#include <weave/keys/utc.hpp>
#include <weave/net/throttle.hpp>

#include <chrono>
#include <functional>
#include <loomlink/keys/password.hpp>
#include <loomlink/store/store.hpp>
#include <loomlink/workflow/caller.hpp>
#include <loomlink/workflow/deed.hpp>
#include <loomlink/workflow/denial.hpp>
#include <loomlink/workflow/recent.hpp>
#include <loomlink/workflow/refusals.hpp>
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
    /// The same look, or the same attempt refused for the same reason, by the same person is logged once in
    /// so long.
    std::chrono::minutes view_again{10};
    net::ThrottleRate refusals{100, 1.0 / 30, 10000};  ///< of one person that are logged
};

/// The server's own keys.
struct ServerKeys {
    KeyPair log, stamp, access;
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

    /// Takes a step: attempt() of a commit().
    Result<Json> take(const Caller& caller, const Ask& ask, const Deed& deed, const Check& check,
                      const Apply& apply);

    /// Attempts a step: a repeated request id is given the answer of the first time, without `work`. What is
    /// refused, bad input included, changes nothing and is logged as `refused`, with the deed as `work` left
    /// it.
    Result<Json> attempt(const Caller& caller, const Ask& ask, const Deed& deed,
                         const std::function<Result<Json>()>& work);

    /// Within an attempt: `check` says whether the step may be taken (asked before the password is tried, and
    /// again in the transaction), then the statement is signed where it has to be, and record, change and
    /// answer are stored together. `check` gets the caller as the store knows the person now.
    Result<Json> commit(const Caller& caller, const Ask& ask, const Deed& deed, const Check& check,
                        const Apply& apply);

    /// What a person looks at; that it was refused is logged as an attempt of this deed.
    template <class Work>
    auto look(const Caller& caller, const Deed& deed, const Work& work) -> decltype(work()) {
        auto seen = work();
        if (!seen) return refuse(caller, {}, deed, seen.error());
        return seen;
    }

    /// Signatures of the person's own key, opened with the password typed for this step alone. Refused and
    /// counted where it is wrong; after too many nobody can try for a while.
    Result<std::vector<Signature>> sign_all(const Caller& caller, const std::string& password,
                                            const std::vector<std::pair<Purpose, std::string>>& messages);

    /// Logs that an attempt of somebody who is signed in was refused, as RefusalGauge lets it, and gives the
    /// error back.
    Error refuse(const Caller& caller, const std::string& request, const Deed& attempt, Error error);
    /// The same for who is not signed in, each time, but not for what cannot be understood: how often that
    /// may be tried is held elsewhere. `actor` is a name that exists, or `nobody`.
    Error refuse_stranger(const std::string& actor, const Deed& attempt, Error error);
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
    /// The answer that a request id was given before. Refused: it was for another step.
    Result<std::optional<Json>> recorded(const Caller& caller, const std::string& request, const Deed& deed);
    void write_refusal(const std::string& actor, const std::string& request, const Deed& record);
    [[nodiscard]] net::Throttle::Clock::time_point throttle_now() const;

    Store m_store;
    ServerKeys m_keys;
    std::string m_site;
    DeskSettings m_settings;
    NowClock m_clock;
    PasswordHasher m_hasher;
    net::Throttle m_names, m_addresses;
    Recent m_views;
    RefusalGauge m_refusals;
};

/// The person as the store knows him or her now. Refused: who was disabled since.
Result<Caller> fresh_caller(const Reader& reader, const Caller& caller);

/// The key of a person that signs now: the newest with a secret that was not revoked.
Result<PersonKey> signing_key(const Reader& reader, Id person);

}  // namespace weave::loomlink
