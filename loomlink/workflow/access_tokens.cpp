#include <weave/keys/access_token.hpp>
#include <weave/keys/codes.hpp>
#include <weave/keys/hex.hpp>

#include <loomlink/workflow/accounts.hpp>

namespace weave::loomlink {

namespace {

/// Who may simulate. Operators weave what is released, and machines sign what they found: neither asks for more.
Status may_simulate(const Caller& caller) {
    if (caller.reads_designs() || caller.is(PersonRole::administrator)) return {};
    return deny(Denial::rights, "simulating takes the role designer, approver, engineer or admin");
}

}  // namespace

Result<Json> Accounts::access_token(const Caller& caller, const Ask& ask, std::int64_t hours) {
    const KeyPair& key = m_desk->keys().access;
    Deed deed{"access.given", caller.login, {}, {{"key", key.id()}, {"hours", hours}}};
    deed.told_once = true;
    return m_desk->attempt(caller, ask, deed, [&]() -> Result<Json> {
        WEAVE_CHECK_OK(may_simulate(caller));
        // Each is a record that stays; who lost one can have another, but not thousands.
        WEAVE_CHECK_OK(m_desk->count_try("access " + caller.login, {}));
        const Instant now = m_desk->now();
        WEAVE_TRY(const std::string token,
                  sign_access_token(key, {m_desk->site(), caller.login, now, now + std::chrono::hours(hours)}));
        const std::string expires = utc_text(now + std::chrono::hours(hours));
        deed.data["expires"] = expires;
        deed.data["token_sha256"] = token_hash(token);
        return m_desk->commit(
            caller, ask, deed, [](const Reader&, const Caller& fresh) { return may_simulate(fresh); },
            [&](Writer&, const TakenStep&) -> Result<Json> {
                return Json{{"token", token}, {"expires", expires}};
            });
    });
}

Json Accounts::access_key() const {
    const KeyPair& key = m_desk->keys().access;
    return {{"site", m_desk->site()}, {"key", key.id()}, {"public", to_hex(key.public_key())}};
}

}  // namespace weave::loomlink
