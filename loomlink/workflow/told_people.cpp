#include <algorithm>
#include <loomlink/store/reader.hpp>
#include <loomlink/workflow/caller.hpp>
#include <loomlink/workflow/policy.hpp>
#include <loomlink/workflow/told.hpp>

namespace weave::loomlink {

namespace {

/// A list of roles by the words of the API, as the store has them: its own words, sorted.
std::vector<std::string> store_roles(const Json& words) {
    std::vector<std::string> roles;
    for (const Json& one : words) roles.emplace_back(word(parse_role(one.get<std::string>()).value()));
    std::sort(roles.begin(), roles.end());
    return roles;
}

std::string joined_words(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& one : words) text += (text.empty() ? "" : ",") + one;
    return text;
}

/// The other way round, as an invitation lists them.
std::string api_roles(const std::vector<std::string>& roles) {
    std::vector<std::string> words;
    for (const std::string& role : roles) words.push_back(role == "administrator" ? "admin" : role);
    return joined_words(words);
}

template <class Value>
Json or_null(const std::optional<Value>& value) {
    return value ? Json(*value) : Json(nullptr);
}

}  // namespace

std::string by_record(const std::string& what, Seq seq) {
    return what + " by record " + std::to_string(seq);
}

void ToldPeople::invited(const Telling& told) {
    m_invitations[told.seq()] = {
        "person", {}, joined_words(told.data("roles")), told.text("expires"), told.text("code_sha256"), {}};
}

void ToldPeople::joined(const Telling& told) {
    ToldPerson& person = m_people[told.subject()];
    if (person.full_name.empty()) person.roles = store_roles(told.data("roles"));
    person.full_name = told.text("full_name");
    person.password_sha256 = told.text("password_sha256");
    person.active = true;
    person.event = told.seq();
    add_key(told, told.subject(), true);
    m_keys.at(told.text("key")).sealed_sha256 = told.text("sealed_sha256");
    use_code(told);
}

void ToldPeople::password_changed(const Telling& told) {
    ToldPerson& person = m_people.at(told.subject());
    person.password_sha256 = told.text("password_sha256");
    person.event = told.seq();
    m_keys.at(told.text("key")).sealed_sha256 = told.text("sealed_sha256");
    end_sessions(told.subject());
}

void ToldPeople::password_rehashed(const Telling& told) {
    m_people.at(told.subject()).password_sha256 = told.text("password_sha256");
}

void ToldPeople::reset(const Telling& told) {
    ToldPerson& person = m_people.at(told.subject());
    person.password_sha256 = hash_hex(sha256(""));
    person.event = told.seq();
    revoke_keys(told.subject(), true, told.seq());
    end_sessions(told.subject());
    m_invitations[told.seq()] = {"person",
                                 told.subject(),
                                 api_roles(person.roles),
                                 told.text("expires"),
                                 told.text("code_sha256"),
                                 {}};
}

void ToldPeople::roles_set(const Telling& told) {
    ToldPerson& person = m_people.at(told.subject());
    person.roles = store_roles(told.data("roles"));
    person.event = told.seq();
}

void ToldPeople::set_active(const Telling& told, bool active) {
    ToldPerson& person = m_people.at(told.subject());
    person.active = active;
    person.event = told.seq();
    if (!active) end_sessions(told.subject());
}

void ToldPeople::signed_in(const Telling& told) {
    m_sessions[told.text("session_sha256")] = told.subject();
}

void ToldPeople::signed_out(const Telling& told) {
    m_sessions.erase(told.text("session_sha256"));
}

void ToldPeople::end_sessions(const std::string& login) {
    std::erase_if(m_sessions, [&](const auto& session) { return session.second == login; });
}

void ToldPeople::signer_invited(const Telling& told) {
    m_invitations[told.seq()] = {"signer",           told.subject(), "", told.text("expires"),
                                 told.text("code_sha256"), {}};
}

void ToldPeople::signer_enrolled(const Telling& told) {
    add_key(told, told.subject(), false);
    use_code(told);
}

void ToldPeople::signer_revoked(const Telling& told) {
    revoke_keys(told.subject(), false, told.seq());
}

void ToldPeople::policy_set(const Telling& told) {
    const Json& policy = told.record.statement.data;
    m_approvals = read_policy(policy).value().approvals;
    m_papers.push_back(kept_thing("policy " + std::to_string(++m_policies),
                                  {canonical_json(policy), told.seq()}));
}

void ToldPeople::trust_published(const Telling& told) {
    m_papers.push_back(kept_thing("trust document " + std::to_string(told.number("number")),
                                  {told.text("body_sha256"), told.seq()}));
}

void ToldPeople::add_key(const Telling& told, const std::string& holder, bool is_person) {
    m_keys[told.text("key")] = {holder, is_person, told.text("public_key"), {}, told.seq(), {}};
}

void ToldPeople::use_code(const Telling& told) {
    const std::string code = told.text("code_sha256");
    for (auto& [seq, invitation] : m_invitations)
        if (invitation.code == code) invitation.used = told.seq();
}

void ToldPeople::revoke_keys(const std::string& holder, bool is_person, Seq seq) {
    for (auto& [id, key] : m_keys)
        if (key.holder == holder && key.is_person == is_person && !key.revoked) key.revoked = seq;
}

bool ToldPeople::holds(const std::string& login, const std::string& key) const {
    const auto known = m_keys.find(key);
    return known != m_keys.end() && known->second.is_person && known->second.holder == login &&
           !known->second.revoked;
}

void ToldPeople::add_to(std::vector<KeptThing>& things) const {
    things.insert(things.end(), m_papers.begin(), m_papers.end());
    for (const auto& [login, person] : m_people)
        things.push_back(kept_thing("person " + login, {person.full_name, person.active,
                                                        person.password_sha256, person.roles, person.event}));
    for (const auto& [id, key] : m_keys)
        things.push_back(kept_thing(
            "key " + id, {key.is_person ? Json(key.holder) : Json(nullptr),
                          key.is_person ? "release" : "evidence", key.public_key,
                          or_null(key.sealed_sha256), key.created, or_null(key.revoked)}));
    for (const auto& [token, login] : m_sessions) things.push_back(kept_thing("session " + token, Json::array({login})));
    for (const auto& [seq, one] : m_invitations)
        things.push_back(kept_thing("invitation of record " + std::to_string(seq),
                                    {one.purpose, or_null(one.name), one.roles, one.expires, one.code,
                                     or_null(one.used)}));
}

}  // namespace weave::loomlink
