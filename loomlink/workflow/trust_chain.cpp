#include <loomlink/workflow/trust_chain.hpp>

#include <algorithm>
#include <loomlink/workflow/accounts.hpp>
#include <loomlink/workflow/policy.hpp>

namespace weave::loomlink {

namespace {

constexpr const char* server_name = "loomlink";

Status add_person_key(const Reader& reader, const Person& person, TrustDocument& trust) {
    if (!person.active) return {};
    const Caller caller = caller_of(person);
    TrustedKey key;
    key.person = person.login;
    if (caller.is(PersonRole::administrator)) key.roles.push_back(Role::root);
    if (caller.is(PersonRole::approver)) key.roles.push_back(Role::release);
    if (key.roles.empty()) return {};
    WEAVE_TRY(const auto keys, reader.keys(person.id));
    for (const PersonKey& own : keys)
        if (!own.revoked && own.sealed) {
            key.public_key = own.public_key;
            trust.keys.push_back(key);
        }
    return {};
}

Status add_signers(const Reader& reader, TrustDocument& trust) {
    WEAVE_TRY(const auto keys, reader.keys({}));
    for (const PersonKey& key : keys) {
        if (key.revoked || key.purpose != "evidence") continue;
        WEAVE_TRY(const EventRecord record, reader.record(key.created));
        trust.keys.push_back({key.public_key, record.statement.subject.value_or(key.id), {Role::evidence}});
    }
    return {};
}

void add_server_key(const PublicKey& key, Role role, TrustDocument& trust) {
    if (trust.find(key_id(key)) == nullptr) trust.keys.push_back({key, server_name, {role}});
}

/// The document that would follow, without a signature.
Result<TrustDocument> next_terms(const Reader& reader, const Desk& desk,
                                 const std::optional<TrustDocument>& before, bool keep_server_keys) {
    TrustDocument next;
    next.version = before ? before->version + 1 : 1;
    next.site = desk.site();
    next.issued = desk.now();
    WEAVE_TRY(const auto people, reader.people());
    for (const Person& person : people) WEAVE_CHECK_OK(add_person_key(reader, person, next));
    add_server_key(desk.keys().stamp.public_key(), Role::stamp, next);
    add_server_key(desk.keys().log.public_key(), Role::log, next);
    if (before && keep_server_keys)
        for (const TrustedKey& key : before->keys)
            for (const Role role : {Role::stamp, Role::log})
                if (key.has(role)) add_server_key(key.public_key, role, next);
    WEAVE_CHECK_OK(add_signers(reader, next));
    WEAVE_TRY(const SitePolicy policy, policy_in_force(reader));
    next.release_threshold = policy.release_signatures;
    return next;
}

/// The signed document, held to what a terminal will hold it to.
Result<std::string> proven_document(const TrustDocument& terms, const Signature& signature,
                                    const std::optional<TrustDocument>& before) {
    const std::string bytes = write_signed({trust_body(terms), {signature}});
    auto read = before ? next_trust(*before, bytes) : read_trust(bytes);
    if (!read)
        return deny(Denial::conflict, "no terminal would take this trust document: " + read.error().text());
    return bytes;
}

}  // namespace

Result<std::optional<TrustDocument>> newest_trust(const Reader& reader) {
    WEAVE_TRY(const auto paper, reader.latest_trust());
    if (!paper) return std::optional<TrustDocument>();
    WEAVE_TRY(TrustDocument trust, read_trust(paper->text));
    return std::optional(std::move(trust));
}

Result<std::vector<std::string>> trust_changes(const Reader& reader, const Desk& desk) {
    WEAVE_TRY(const auto before, newest_trust(reader));
    WEAVE_TRY(const TrustDocument next, next_terms(reader, desk, before, true));
    std::vector<std::string> changes;
    for (const TrustedKey& key : next.keys) {
        const TrustedKey* old = before ? before->find(key.id()) : nullptr;
        if (old == nullptr)
            changes.push_back("the key of " + key.person + " is not listed yet");
        else if (old->roles != key.roles)
            changes.push_back("the key of " + key.person + " counts for other things now");
    }
    if (before)
        for (const TrustedKey& key : before->keys)
            if (next.find(key.id()) == nullptr)
                changes.push_back("a key of " + key.person + " is still listed");
    if (before && before->release_threshold != next.release_threshold)
        changes.emplace_back("another number of people must sign a release");
    return changes;
}

Result<Json> TrustChain::documents(std::int64_t from) {
    return m_desk->store().read([&](const Reader& reader) -> Result<Json> {
        WEAVE_TRY(const auto papers, reader.trust_documents(from));
        WEAVE_TRY(const auto newest, newest_trust(reader));
        Json texts = Json::array();
        for (const SitePaper& paper : papers) texts.push_back(paper.text);
        return Json{{"number", newest ? Json(newest->version) : Json(nullptr)},
                    {"fingerprint", newest ? Json(newest->fingerprint()) : Json(nullptr)},
                    {"documents", std::move(texts)}};
    });
}

Result<Json> TrustChain::pending(const Caller& caller) {
    return m_desk->store().read([&](const Reader& reader) -> Result<Json> {
        WEAVE_CHECK_OK(need_role(caller, PersonRole::administrator));
        WEAVE_TRY(const auto changes, trust_changes(reader, *m_desk));
        return Json{{"changes", changes}};
    });
}

Result<Json> TrustChain::publish(const Caller& caller, const Ask& ask, bool keep_server_keys) {
    Deed deed{"trust.published", "trust", {}, Json::object()};
    deed.is_signed = true;
    return m_desk->attempt(caller, ask, deed,
                           [&] { return publish_next(caller, ask, deed, keep_server_keys); });
}

/// Signs the document that is due; what is signed is added to the deed.
Result<Json> TrustChain::publish_next(const Caller& caller, const Ask& ask, Deed& deed,
                                      bool keep_server_keys) {
    std::optional<TrustDocument> before;
    WEAVE_TRY(const TrustDocument next,
              m_desk->store().read([&](const Reader& reader) -> Result<TrustDocument> {
                  WEAVE_TRY(before, newest_trust(reader));
                  return next_terms(reader, *m_desk, before, keep_server_keys);
              }));
    deed.data = {{"number", next.version}, {"body_sha256", body_sha256({trust_body(next), {}})}};
    deed.also = {{Purpose::trust_document, canonical_json(trust_body(next))}};
    return m_desk->commit(
        caller, ask, deed,
        [&](const Reader& reader, const Caller& now) -> Status {
            WEAVE_CHECK_OK(need_role(now, PersonRole::administrator));
            WEAVE_TRY(const auto newest, reader.latest_trust());
            if ((newest ? newest->number : 0) + 1 == static_cast<std::int64_t>(next.version)) return {};
            return deny(Denial::conflict, "somebody else signed a trust document meanwhile");
        },
        [&](Writer& writer, const TakenStep& step) -> Result<Json> {
            WEAVE_TRY(const std::string bytes, proven_document(next, step.also.front(), before));
            WEAVE_TRY(const Hash object, writer.put_object(bytes));
            WEAVE_CHECK_OK(writer.add_trust(static_cast<std::int64_t>(next.version), object, step.event));
            return Json{{"number", next.version}, {"fingerprint", body_sha256({trust_body(next), {}})}};
        });
}

}  // namespace weave::loomlink
