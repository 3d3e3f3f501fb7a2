#include <weave/core/log.hpp>
#include <weave/core/text.hpp>

#include <algorithm>
#include <loomlink/keys/codes.hpp>
#include <loomlink/keys/sealed_key.hpp>
#include <loomlink/workflow/desk.hpp>

namespace weave::loomlink {

namespace {

constexpr std::size_t least_request = 8, most_request = 64, most_views = 10000;

bool is_plain(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
}

Status check_request(const std::string& request) {
    if (request.size() >= least_request && request.size() <= most_request &&
        std::all_of(request.begin(), request.end(), is_plain))
        return {};
    return bad_input("must be 8 to 64 letters, digits, '.', '-' or '_'", "request");
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

/// Refusals that are worth a record: of rights, states, passwords and rules; not what cannot be understood.
bool is_logged(const Error& error) {
    return (error.code == ErrorCode::refused || error.code == ErrorCode::invalid) &&
           denial_of(error) != Denial::often;
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
      m_addresses(settings.by_address) {}

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
    WEAVE_TRY(const auto known, recorded(caller, ask.request, deed));
    if (known) return *known;
    auto answer = take_allowed(caller, ask, deed, check, apply);
    if (!answer) return refuse(caller.login, ask.request, deed, answer.error());
    return answer;
}

Result<Json> Desk::take_allowed(const Caller& caller, const Ask& ask, const Deed& deed, const Check& check,
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

Error Desk::refuse(const std::string& actor, const std::string& request, const Deed& deed, Error error) {
    if (!is_logged(error)) return error;
    Deed refusal{"refused", deed.subject, error.message, {{"what", deed.kind}}};
    const auto logged =
        m_store.write([&](Writer& writer) { return writer.append(statement_of(actor, request, refusal)); });
    if (!logged) log(LogLevel::warning, "a refusal could not be logged: " + logged.error().text());
    return error;
}

Status Desk::note_view(const Caller& caller, const std::string& kind, const std::string& subject,
                       const Json& data) {
    const Instant moment = now();
    const std::string look = caller.login + '\n' + kind + '\n' + subject;
    {
        const std::lock_guard lock(m_views_mutex);
        if (m_views.size() >= most_views)
            std::erase_if(m_views,
                          [&](const auto& entry) { return entry.second + m_settings.view_again <= moment; });
        if (m_views.size() >= most_views) m_views.clear();  // rather one record too many than none
        const auto [place, is_new] = m_views.try_emplace(look, moment);
        if (!is_new && moment < place->second + m_settings.view_again) return {};
        place->second = moment;
    }
    Status logged = note(caller.login, kind, subject, data);
    if (!logged) {  // the next look is not one that was told before
        const std::lock_guard lock(m_views_mutex);
        m_views.erase(look);
    }
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

Status check_text(const std::string& text, const std::string& member, std::size_t least, std::size_t most) {
    if (!is_utf8(text)) return bad_input("is not UTF-8", member);
    if (text.size() < least) return bad_input("is missing", member);
    if (text.size() > most) return bad_input("has more than " + std::to_string(most) + " bytes", member);
    const bool control = std::any_of(text.begin(), text.end(), [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return (byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7f;
    });
    return control ? Status(bad_input("has control characters", member)) : Status();
}

Status check_name(const std::string& name, const std::string& member, bool spaces) {
    constexpr std::size_t most = 64;
    const bool fits =
        !name.empty() && name.size() <= most && is_plain(name.front()) && is_plain(name.back()) &&
        name.front() != '.' && name.front() != '-' &&
        std::all_of(name.begin(), name.end(), [&](char c) { return is_plain(c) || (spaces && c == ' '); });
    if (fits) return {};
    return bad_input(std::string("must be 1 to 64 letters, digits, '.', '-' or '_'") +
                         (spaces ? ", with spaces within" : "") + ", and start with a letter or digit",
                     member);
}

}  // namespace weave::loomlink
