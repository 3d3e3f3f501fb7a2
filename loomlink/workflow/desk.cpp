#include <loomlink/workflow/desk.hpp>

#include <weave/core/log.hpp>
#include <weave/keys/codes.hpp>

#include <algorithm>
#include <loomlink/keys/sealed_key.hpp>

namespace weave::loomlink {

namespace {

constexpr std::size_t least_request = 8, most_request = 64;

bool is_plain(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
}

Status check_request(const std::string& request) {
    if (request.size() >= least_request && request.size() <= most_request &&
        std::all_of(request.begin(), request.end(), is_plain))
        return {};
    return bad_input("must be 8 to 64 of the letters a to z, digits, '.', '-' and '_'", "request");
}

/// What is kept beside an answer, so that an id that is used for something else is found out.
std::string kept_answer(const Deed& deed, const Json& answer) {
    return canonical_json({{"kind", deed.kind},
                           {"subject", deed.subject},
                           {"answer", deed.told_once ? Json(nullptr) : answer}});
}

Result<Json> answer_from(const std::string& kept, const Deed& deed) {
    WEAVE_TRY(const Json json, parse_json(kept));
    if (json.at("kind") != deed.kind || json.at("subject") != deed.subject)
        return deny(Denial::conflict, "this request id was used for something else");
    if (deed.told_once)
        return deny(Denial::conflict, "this was done already, and its answer is given once only");
    return json.at("answer");
}

}  // namespace

NowClock system_clock() {
    return [] {
        return std::chrono::time_point_cast<std::chrono::milliseconds>(std::chrono::system_clock::now());
    };
}

Desk::Desk(Store store, ServerKeys keys, std::string site, DeskSettings settings, NowClock clock)
    : m_store(std::move(store)),
      m_keys(std::move(keys)),
      m_site(std::move(site)),
      m_settings(settings),
      m_clock(std::move(clock)),
      m_hasher(settings.login_cost),
      m_names(settings.by_name),
      m_addresses(settings.by_address),
      m_views(settings.view_again),
      m_refusals(settings.view_again, settings.refusals) {}

net::Throttle::Clock::time_point Desk::throttle_now() const {
    return net::Throttle::Clock::time_point(now().time_since_epoch());
}

Statement Desk::statement_of(const std::string& actor, const std::string& request, const Deed& deed) const {
    Statement statement{m_site, deed.kind, now_text(), actor, {}, {}, request, deed.data};
    if (!deed.subject.empty()) statement.subject = deed.subject;
    if (!deed.reason.empty()) statement.reason = deed.reason;
    return statement;
}

Result<std::optional<Json>> Desk::recorded(const Caller& caller, const std::string& request,
                                           const Deed& deed) {
    WEAVE_CHECK_OK(check_request(request));
    WEAVE_TRY(const auto kept,
              m_store.read([&](const Reader& reader) { return reader.answer(request, caller.id); }));
    if (!kept) return std::optional<Json>();
    WEAVE_TRY(Json answer, answer_from(*kept, deed));
    return std::optional(std::move(answer));
}

Result<Json> Desk::take(const Caller& caller, const Ask& ask, const Deed& deed, const Check& check,
                        const Apply& apply) {
    return attempt(caller, ask, deed, [&] { return commit(caller, ask, deed, check, apply); });
}

Result<Json> Desk::attempt(const Caller& caller, const Ask& ask, const Deed& deed,
                           const std::function<Result<Json>()>& work) {
    const auto known = recorded(caller, ask.request, deed);
    if (!known) return refuse(caller, ask.request, deed, known.error());
    if (*known) return **known;
    auto answer = work();
    if (answer) return answer;
    // The same request, come twice at a time, may have been done between the look above and the work's own checks,
    // which then find its traces ("this name is taken").
    const auto since = recorded(caller, ask.request, deed);
    if (since && *since) return **since;
    return refuse(caller, ask.request, deed, answer.error());
}

Result<Json> Desk::commit(const Caller& caller, const Ask& ask, const Deed& deed, const Check& check,
                          const Apply& apply) {
    const auto allowed = [&](const Reader& reader) -> Status {
        WEAVE_TRY(const Caller fresh, fresh_caller(reader, caller));
        return check(reader, fresh);
    };
    WEAVE_CHECK_OK(m_store.read(allowed));
    const Statement statement = statement_of(caller.login, ask.request, deed);
    std::optional<RecordSignature> signature;
    TakenStep step;
    step.at = statement.at;
    if (deed.is_signed) {
        auto messages = deed.also;
        messages.emplace_back(Purpose::statement, statement_bytes(statement));
        WEAVE_TRY(step.also, sign_all(caller, ask.password, messages));
        signature = RecordSignature{step.also.back().key, step.also.back().value};
        step.also.pop_back();
    }
    return m_store.write([&](Writer& writer) -> Result<Json> {
        WEAVE_TRY(const auto kept, writer.answer(ask.request, caller.id));
        if (kept) return answer_from(*kept, deed);  // the same request came twice at a time
        WEAVE_CHECK_OK(allowed(writer));
        WEAVE_TRY(step.event, writer.append(statement, signature));
        WEAVE_TRY(Json answer, apply(writer, step));
        WEAVE_CHECK_OK(writer.record_answer(ask.request, caller.id, kept_answer(deed, answer)));
        return answer;
    });
}

Result<std::vector<Signature>> Desk::sign_all(const Caller& caller, const std::string& password,
                                              const std::vector<std::pair<Purpose, std::string>>& messages) {
    const std::string name =
        "sign " + caller.login;  // so that false log-ins do not keep a person from signing
    WEAVE_CHECK_OK(count_try(name, {}));
    WEAVE_TRY(const PersonKey key,
              m_store.read([&](const Reader& reader) { return signing_key(reader, caller.id); }));
    WEAVE_TRY(const SealedKey sealed, read_sealed_key(*key.sealed));
    std::vector<Signature> signatures;
    for (const auto& [purpose, message] : messages) {
        auto made = sign_with(sealed, password, purpose, message);
        if (!made) return deny(Denial::password, "the password is wrong; nothing was signed");
        signatures.push_back(*std::move(made));
    }
    forgive(name);
    return signatures;
}

void Desk::write_refusal(const std::string& actor, const std::string& request, const Deed& record) {
    const std::string id = check_request(request) ? request : make_token();
    const auto logged =
        m_store.write([&](Writer& writer) { return writer.append(statement_of(actor, id, record)); });
    if (!logged) log(LogLevel::warning, "a refusal could not be logged: " + logged.error().text());
}

Error Desk::refuse(const Caller& caller, const std::string& request, const Deed& attempt, Error error) {
    const auto denial = denial_of(error);
    const bool is_logged = error.code == ErrorCode::refused || error.code == ErrorCode::invalid ||
                           error.code == ErrorCode::bad_input;
    if (!is_logged || denial == Denial::often) return error;
    Deed record = refusal_record(attempt, error);
    // Wrong passwords are throttled where they are tried, so each of them can be told.
    const auto left_out = m_refusals.admit(caller.login, record, denial == Denial::password, now());
    if (!left_out) return error;
    if (*left_out > 0) record.data["left_out"] = *left_out;
    write_refusal(caller.login, request, record);
    return error;
}

Error Desk::refuse_stranger(const std::string& actor, const Deed& attempt, Error error) {
    const bool is_logged = error.code == ErrorCode::refused || error.code == ErrorCode::invalid;
    if (is_logged && denial_of(error) != Denial::often)
        write_refusal(actor, make_token(), refusal_record(attempt, error));
    return error;
}

Status Desk::note_view(const Caller& caller, const std::string& kind, const std::string& subject,
                       const Json& data) {
    const std::string look = canonical_json(Json::array({caller.login, kind, subject, data}));
    if (!m_views.is_new(look, now())) return {};
    Status logged = note(caller.login, kind, subject, data);
    if (!logged) m_views.forget(look);  // the next look is not one that was told before
    return logged;
}

Status Desk::note(const std::string& actor, const std::string& kind, const std::string& subject,
                  const Json& data) {
    const Deed deed{kind, subject, {}, data};
    const auto logged =
        m_store.write([&](Writer& writer) { return writer.append(statement_of(actor, make_token(), deed)); });
    return logged ? Status() : Status(logged.error());
}

Status Desk::count_try(const std::string& name, const std::string& address) {
    const auto moment = throttle_now();
    if (!name.empty() && !m_names.take(name, moment))
        return deny(Denial::often, "too many tries; wait " +
                                       std::to_string(m_names.wait(name, moment).count()) + " seconds");
    if (!address.empty() && !m_addresses.take(address, moment))
        return deny(Denial::often, "too many tries from here; wait " +
                                       std::to_string(m_addresses.wait(address, moment).count()) +
                                       " seconds");
    return {};
}

void Desk::forgive(const std::string& name) {
    m_names.forgive(name);
}

Result<Caller> fresh_caller(const Reader& reader, const Caller& caller) {
    WEAVE_TRY(const auto person, reader.person(caller.id));
    if (!person || !person->active) return deny(Denial::who, "your account is closed");
    return caller_of(*person);
}

Result<PersonKey> signing_key(const Reader& reader, Id person) {
    WEAVE_TRY(const auto keys, reader.keys(person));
    for (auto key = keys.rbegin(); key != keys.rend(); ++key)
        if (!key->revoked && key->sealed) return *key;
    return deny(Denial::conflict, "you have no signing key");
}

}  // namespace weave::loomlink
