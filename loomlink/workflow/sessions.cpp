#include <weave/keys/codes.hpp>

#include <loomlink/workflow/accounts.hpp>

namespace weave::loomlink {

namespace {

Error nobody() {
    return deny(Denial::who, "the session has ended: sign in again");
}

Result<Hash> token_key(const std::string& token) {
    constexpr std::size_t most_token = 128;
    if (token.empty() || token.size() > most_token) return nobody();
    return *parse_hash(token_hash(token));
}

/// The person, or nothing where the account is closed or waits for a new key.
std::optional<std::string> stored_password(const std::optional<Person>& person) {
    if (!person || !person->active || person->password.empty()) return {};
    return person->password;
}

}  // namespace

Result<Json> Accounts::open_session(const Person& person) {
    const std::string token = make_token(), csrf = make_token();
    WEAVE_TRY(const Hash key, token_key(token));
    const std::string expires = utc_text(m_desk->now() + m_desk->settings().session);
    return m_desk->store().write([&](Writer& writer) -> Result<Json> {
        const Deed deed{"person.signed_in", person.login, {}, {{"session_sha256", hash_hex(key)}}};
        WEAVE_CHECK_OK(writer.append(m_desk->statement_of(person.login, make_token(), deed)));
        WEAVE_CHECK_OK(writer.drop_expired_sessions(m_desk->now_text()));
        WEAVE_CHECK_OK(writer.add_session({key, person.id, expires, csrf}));
        WEAVE_TRY(Json told, person_json(writer, person));
        return Json{{"token", token}, {"expires", expires}, {"csrf", csrf}, {"person", std::move(told)}};
    });
}

Result<Json> Accounts::log_in(const std::string& name, const std::string& password,
                              const std::string& address) {
    constexpr std::size_t most_typed = 1024;
    if (name.size() > most_typed || password.size() > most_typed)
        return bad_input("name or password is too long");
    WEAVE_CHECK_OK(m_desk->count_try("log in " + name, address));
    WEAVE_TRY(const auto person,
              m_desk->store().read([&](const Reader& reader) { return reader.person(name); }));
    const auto stored = stored_password(person);
    if (!m_desk->hasher().matches(stored, password)) {
        // What was typed as a name may be a password: only names that exist are written down.
        const std::string actor = person ? person->login : "nobody";
        return m_desk->refuse_stranger(actor, {"person.signed_in", {}, {}, Json::object()},
                                       deny(Denial::who, "name or password is wrong"));
    }
    m_desk->forgive("log in " + name);
    if (m_desk->hasher().is_stale(*stored)) {
        const std::string anew = m_desk->hasher().hash(password);
        const Status stored_anew = m_desk->store().write([&](Writer& writer) -> Status {
            WEAVE_TRY(auto now, writer.person(person->id));
            if (!now || now->password != *stored) return {};  // changed meanwhile
            now->password = anew;
            const Deed deed{"person.password_rehashed",
                            now->login,
                            {},
                            {{"password_sha256", hash_hex(sha256(anew))}}};
            WEAVE_CHECK_OK(writer.append(m_desk->statement_of("loomlink", make_token(), deed)));
            return writer.update_person(*now);
        });
        WEAVE_CHECK_OK(stored_anew);
    }
    return open_session(*person);
}

Result<Json> Accounts::log_out(const std::string& token) {
    WEAVE_TRY(const SignedIn signed_in, who(token));
    WEAVE_TRY(const Hash key, token_key(token));
    const Deed deed{
        "person.signed_out", signed_in.caller.login, {}, {{"session_sha256", hash_hex(key)}}};
    return m_desk->store().write([&](Writer& writer) -> Result<Json> {
        WEAVE_CHECK_OK(writer.append(m_desk->statement_of(signed_in.caller.login, make_token(), deed)));
        WEAVE_CHECK_OK(writer.end_session(key));
        return Json::object();
    });
}

Result<SignedIn> Accounts::who(const std::string& token) {
    WEAVE_TRY(const Hash key, token_key(token));
    const std::string now = m_desk->now_text();
    std::optional<Session> session;
    WEAVE_TRY(SignedIn found, m_desk->store().read([&](const Reader& reader) -> Result<SignedIn> {
        WEAVE_TRY(session, reader.session(key, now));
        if (!session) return nobody();
        WEAVE_TRY(const auto person, reader.person(session->person));
        if (!person || !person->active) return nobody();
        return SignedIn{caller_of(*person), session->csrf, session->expires};
    }));
    // Moved on only once half of it is over, so that looking at pages does not write all the time.
    if (session->expires > utc_text(m_desk->now() + m_desk->settings().session / 2)) return found;
    session->expires = utc_text(m_desk->now() + m_desk->settings().session);
    found.expires = session->expires;
    const Status moved = m_desk->store().write([&](Writer& writer) -> Status {
        WEAVE_TRY(const auto still, writer.session(key, now));
        if (!still) return nobody();
        WEAVE_CHECK_OK(writer.end_session(key));
        return writer.add_session(*session);
    });
    WEAVE_CHECK_OK(moved);
    return found;
}

Result<Json> Accounts::me(const SignedIn& signed_in) {
    return m_desk->store().read([&](const Reader& reader) -> Result<Json> {
        WEAVE_TRY(const auto person, reader.person(signed_in.caller.id));
        if (!person) return nobody();
        WEAVE_TRY(Json told, person_json(reader, *person));
        return Json{{"person", std::move(told)}, {"csrf", signed_in.csrf}, {"expires", signed_in.expires}};
    });
}

}  // namespace weave::loomlink
