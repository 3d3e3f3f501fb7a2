#include <loomlink/workflow/accounts.hpp>

#include <weave/core/text.hpp>
#include <weave/keys/codes.hpp>
#include <weave/keys/hex.hpp>

#include <algorithm>
#include <loomlink/keys/file_name.hpp>
#include <loomlink/keys/sealed_key.hpp>
#include <loomlink/workflow/names.hpp>
#include <loomlink/workflow/policy.hpp>
#include <sstream>

namespace weave::loomlink {

namespace {

constexpr const char* server_actor = "loomlink";

Result<std::vector<PersonRole>> roles_from(const std::vector<std::string>& words) {
    std::vector<PersonRole> roles;
    for (const std::string& text : words) {
        const auto role = parse_role(text);
        if (!role) return bad_input("'" + on_one_line(text) + "' is no role", "roles");
        if (std::find(roles.begin(), roles.end(), *role) == roles.end()) roles.push_back(*role);
    }
    if (roles.empty()) return bad_input("names no role", "roles");
    return roles;
}

std::string joined(const std::vector<PersonRole>& roles) {
    std::string text;
    for (const PersonRole role : roles) text += (text.empty() ? "" : ",") + std::string(role_word(role));
    return text;
}

Result<std::vector<PersonRole>> split_roles(const std::string& text) {
    std::vector<std::string> words;
    std::istringstream rest(text);
    for (std::string part; std::getline(rest, part, ',');) words.push_back(part);
    return roles_from(words);
}

Json role_list(const std::vector<PersonRole>& roles) {
    Json list = Json::array();
    for (const PersonRole role : roles) list.push_back(role_word(role));
    return list;
}

Status check_login(const std::string& name) {
    constexpr std::size_t most = 64;
    const auto fits = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); };
    const bool plain = std::all_of(name.begin(), name.end(),
                                   [&](char c) { return fits(c) || c == '.' || c == '_' || c == '-'; });
    if (!name.empty() && name.size() <= most && fits(name.front()) && plain && name != server_actor)
        return {};
    return bad_input(
        "must be 1 to 64 of the small letters a to z, digits, '.', '-' and '_', and start with a letter or "
        "digit",
        "name");
}

Result<Hash> hash_of_code(const std::string& code) {
    WEAVE_TRY(const std::string text, code_hash(code));
    return *parse_hash(text);
}

Status revoke_keys(Writer& writer, Id person, Seq event) {
    WEAVE_TRY(const auto keys, writer.keys(person));
    for (const PersonKey& key : keys)
        if (!key.revoked) WEAVE_CHECK_OK(writer.revoke_key(key.id, event));
    return {};
}

Result<Person> person_named(const Reader& reader, const std::string& name) {
    WEAVE_TRY(auto person, reader.person(name));
    if (!person) return deny(Denial::absent, "there is nobody of this name");
    return *std::move(person);
}

/// A site without an administrator that can sign in would be shut.
Status check_an_admin_stays(const Reader& reader, Id leaving) {
    WEAVE_TRY(const auto people, reader.people());
    const bool stays = std::any_of(people.begin(), people.end(), [&](const Person& person) {
        return person.id != leaving && person.active && caller_of(person).is(PersonRole::administrator);
    });
    return stays ? Status() : Status(deny(Denial::conflict, "this is the last administrator"));
}

PersonKey key_row(const SealedKey& key, Id person, Seq event) {
    PersonKey row;
    row.id = key.id();
    row.person = person;
    row.purpose = "release";
    row.public_key = key.public_key;
    row.sealed = write_sealed_key(key);
    row.created = event;
    return row;
}

}  // namespace

Status need_role(const Caller& caller, PersonRole role) {
    if (caller.is(role)) return {};
    return deny(Denial::rights, std::string("this takes the role ") + role_word(role));
}

Result<Json> person_json(const Reader& reader, const Person& person) {
    const auto key = signing_key(reader, person.id);
    if (!key && key.error().code == ErrorCode::system) return key.error();
    return Json{{"name", person.login},
                {"full_name", person.full_name},
                {"roles", role_list(person.roles)},
                {"key", key ? Json(key->id) : Json(nullptr)}};
}

Result<Json> Accounts::first_invitation() {
    const auto known =
        m_desk->store().read([](const Reader& reader) { return reader.people(); });
    if (!known) return known.error();
    if (!known->empty()) return deny(Denial::conflict, "this site has people already");
    return invite_admin(Json::object());
}

Result<Json> Accounts::recovery_invitation() {
    return invite_admin({{"recovery", true}});
}

/// An invitation that the server makes by itself. Without `recovery` it ends when the first person joins.
Result<Json> Accounts::invite_admin(Json data) {
    const std::string code = make_code();
    WEAVE_TRY(const Hash hash, hash_of_code(code));
    const std::string expires = utc_text(m_desk->now() + m_desk->settings().invitation);
    data["roles"] = Json::array({"admin"});
    data["code_sha256"] = hash_hex(hash);
    data["expires"] = expires;
    const Deed deed{"person.invited", {}, {}, data};
    const Status stored = m_desk->store().write([&](Writer& writer) -> Status {
        WEAVE_TRY(const Seq event, writer.append(m_desk->statement_of(server_actor, make_token(), deed)));
        return writer.add_invitation({hash, "person", {}, "admin", expires, event, {}});
    });
    WEAVE_CHECK_OK(stored);
    return Json{{"code", code}, {"expires", expires}};
}

Result<Json> Accounts::invite(const Caller& caller, const Ask& ask, const std::vector<std::string>& roles) {
    const std::string code = make_code();
    WEAVE_TRY(const Hash hash, hash_of_code(code));
    const std::string expires = utc_text(m_desk->now() + m_desk->settings().invitation);
    Deed deed{"person.invited", {}, {}, {{"roles", roles}}};
    deed.told_once = true;
    return m_desk->attempt(caller, ask, deed, [&]() -> Result<Json> {
        WEAVE_TRY(const auto wanted, roles_from(roles));
        deed.data = {{"roles", role_list(wanted)}, {"code_sha256", hash_hex(hash)}, {"expires", expires}};
        return m_desk->commit(
            caller, ask, deed,
            [](const Reader&, const Caller& now) { return need_role(now, PersonRole::administrator); },
            [&](Writer& writer, const TakenStep& step) -> Result<Json> {
                WEAVE_CHECK_OK(
                    writer.add_invitation({hash, "person", {}, joined(wanted), expires, step.event, {}}));
                return Json{{"code", code}, {"expires", expires}};
            });
    });
}

Result<Json> Accounts::join(const std::string& code, const std::string& name, const std::string& full_name,
                            const std::string& password, const std::string& address) {
    WEAVE_CHECK_OK(m_desk->count_try({}, address));
    WEAVE_CHECK_OK(check_login(name));
    WEAVE_CHECK_OK(check_line(full_name, "full_name", 1, 128));
    WEAVE_CHECK_OK(check_password(password, name, full_name));
    Person wish;
    wish.login = name;
    wish.full_name = full_name;
    auto joined_person = add_invited(code, wish, password);
    if (joined_person) return joined_person;
    return m_desk->refuse_stranger("nobody", {"person.joined", {}, {}, Json::object()},
                                   joined_person.error());
}

/// The account and its key in one step. What the code is for is asked before the password is hashed, so that
/// guessing codes costs the server little.
Result<Json> Accounts::add_invited(const std::string& code, const Person& wish, const std::string& password) {
    WEAVE_TRY(const Hash hash, hash_of_code(code));
    const auto usable = [&](const Reader& reader) -> Result<Invitation> {
        WEAVE_TRY(const auto found, reader.invitation(hash));
        if (!found || found->purpose != "person" || found->used || found->expires <= m_desk->now_text())
            return deny(Denial::rights, "this code is not, or no longer, good");
        WEAVE_TRY(const EventRecord invited, reader.record(found->event));
        WEAVE_TRY(const auto everybody, reader.people());
        if (invited.statement.actor == server_actor && !invited.statement.data.contains("recovery") &&
            !everybody.empty())
            return deny(Denial::rights, "this code was for the first administrator, who has joined");
        if (found->name && *found->name != wish.login)
            return deny(Denial::rights, "this code is for the name '" + *found->name + "'");
        WEAVE_TRY(const auto same, reader.person(wish.login));
        if (same && !found->name) return deny(Denial::conflict, "the name is taken");
        for (const Person& other : everybody)
            if (other.login != wish.login && folded_name(other.full_name) == folded_name(wish.full_name))
                return deny(Denial::conflict, "somebody of this full name is here already: add what tells you apart");
        return *found;
    };
    WEAVE_TRY(const Invitation asked, m_desk->store().read(usable));
    Person person = wish;
    WEAVE_TRY(person.roles, split_roles(asked.roles));
    person.password = m_desk->hasher().hash(password);
    const SealedKey key = make_sealed_key(wish.login, password, m_desk->settings().key_cost);
    const Deed deed{"person.joined",
                    wish.login,
                    {},
                    {{"full_name", wish.full_name},
                     {"roles", role_list(person.roles)},
                     {"key", key.id()},
                     {"public_key", to_hex(key.public_key)},
                     {"sealed_sha256", hash_hex(sha256(write_sealed_key(key)))},
                     {"password_sha256", hash_hex(sha256(person.password))},
                     {"code_sha256", hash_hex(hash)}}};
    const Status stored = m_desk->store().write([&](Writer& writer) -> Status {
        WEAVE_CHECK_OK(usable(writer));
        WEAVE_TRY(person.event, writer.append(m_desk->statement_of(wish.login, make_token(), deed)));
        WEAVE_TRY(const auto before, writer.person(wish.login));
        if (before) {
            person.id = before->id;
            person.roles = before->roles;
            WEAVE_CHECK_OK(writer.update_person(person));
        } else {
            WEAVE_TRY(person.id, writer.add_person(person));
        }
        WEAVE_CHECK_OK(writer.add_key(key_row(key, person.id, person.event)));
        return writer.use_invitation(hash, person.event);
    });
    WEAVE_CHECK_OK(stored);
    return open_session(person);
}

Result<Json> Accounts::change_password(const Caller& caller, const Ask& ask, const std::string& old_password,
                                       const std::string& new_password) {
    const Deed deed{"person.password_changed", caller.login, {}, Json::object()};
    return m_desk->attempt(caller, ask, deed, [&]() -> Result<Json> {
        WEAVE_CHECK_OK(check_password(new_password, caller.login, caller.full_name));
        const std::string name = "sign " + caller.login;
        WEAVE_CHECK_OK(m_desk->count_try(name, {}));
        WEAVE_TRY(const PersonKey key,
                  m_desk->store().read([&](const Reader& reader) { return signing_key(reader, caller.id); }));
        WEAVE_TRY(const SealedKey sealed, read_sealed_key(key.sealed.value_or("")));
        const auto anew =
            loomlink::change_password(sealed, old_password, new_password, m_desk->settings().key_cost);
        if (!anew) return deny(Denial::password, "the password until now is wrong");
        m_desk->forgive(name);
        return reseal(caller, ask, deed, key, *anew, new_password);
    });
}

/// Puts the key that was sealed anew in the place of `key`, and ends all sessions.
Result<Json> Accounts::reseal(const Caller& caller, const Ask& ask, Deed deed, const PersonKey& key,
                              const SealedKey& anew, const std::string& new_password) {
    const std::string hashed = m_desk->hasher().hash(new_password);
    deed.data["password_sha256"] = hash_hex(sha256(hashed));
    deed.data["key"] = key.id;
    deed.data["sealed_sha256"] = hash_hex(sha256(write_sealed_key(anew)));
    return m_desk->commit(
        caller, ask, deed,
        [&](const Reader& reader, const Caller&) -> Status {
            WEAVE_TRY(const PersonKey now, signing_key(reader, caller.id));
            if (now.id == key.id && now.sealed == key.sealed) return {};
            return deny(Denial::conflict, "the password was changed meanwhile");
        },
        [&](Writer& writer, const TakenStep& step) -> Result<Json> {
            WEAVE_TRY(auto person, writer.person(caller.id));
            person->password = hashed;
            person->event = step.event;
            WEAVE_CHECK_OK(writer.update_person(*person));
            WEAVE_CHECK_OK(writer.reseal_key(key.id, write_sealed_key(anew)));
            WEAVE_CHECK_OK(writer.end_sessions(caller.id));
            return Json::object();
        });
}

Result<Json> Accounts::people(const Caller& caller) {
    return m_desk->store().read([&](const Reader& reader) -> Result<Json> {
        WEAVE_CHECK_OK(need_role(caller, PersonRole::administrator));
        WEAVE_TRY(const auto people, reader.people());
        Json list = Json::array();
        for (const Person& person : people) {
            WEAVE_TRY(Json entry, person_json(reader, person));
            entry["active"] = person.active;
            list.push_back(std::move(entry));
        }
        return Json{{"people", std::move(list)}};
    });
}

Result<Json> Accounts::set_roles(const Caller& caller, const Ask& ask, const std::string& name,
                                 const std::vector<std::string>& roles) {
    Deed deed{"person.roles_set", name, {}, {{"roles", roles}}};
    return m_desk->attempt(caller, ask, deed, [&]() -> Result<Json> {
        WEAVE_TRY(const auto wanted, roles_from(roles));
        deed.data = {{"roles", role_list(wanted)}};
        const bool stays_admin =
            std::find(wanted.begin(), wanted.end(), PersonRole::administrator) != wanted.end();
        return m_desk->commit(
            caller, ask, deed,
            [&](const Reader& reader, const Caller& now) -> Status {
                WEAVE_CHECK_OK(need_role(now, PersonRole::administrator));
                WEAVE_TRY(const Person person, person_named(reader, name));
                return stays_admin ? Status() : check_an_admin_stays(reader, person.id);
            },
            [&](Writer& writer, const TakenStep& step) -> Result<Json> {
                WEAVE_TRY(Person person, person_named(writer, name));
                person.roles = wanted;
                person.event = step.event;
                WEAVE_CHECK_OK(writer.update_person(person));
                return person_json(writer, person);
            });
    });
}

Result<Json> Accounts::set_active(const Caller& caller, const Ask& ask, const std::string& name,
                                  bool active) {
    const Deed deed{active ? "person.enabled" : "person.disabled", name, {}, Json::object()};
    return m_desk->take(
        caller, ask, deed,
        [&](const Reader& reader, const Caller& now) -> Status {
            WEAVE_CHECK_OK(need_role(now, PersonRole::administrator));
            WEAVE_TRY(const Person person, person_named(reader, name));
            return active ? Status() : check_an_admin_stays(reader, person.id);
        },
        [&](Writer& writer, const TakenStep& step) -> Result<Json> {
            WEAVE_TRY(Person person, person_named(writer, name));
            person.active = active;
            person.event = step.event;
            WEAVE_CHECK_OK(writer.update_person(person));
            if (!active) WEAVE_CHECK_OK(writer.end_sessions(person.id));
            return person_json(writer, person);
        });
}

Result<Json> Accounts::reset(const Caller& caller, const Ask& ask, const std::string& name) {
    const std::string code = make_code();
    WEAVE_TRY(const Hash hash, hash_of_code(code));
    const std::string expires = utc_text(m_desk->now() + m_desk->settings().invitation);
    Deed deed{"person.reset", name, {}, {{"code_sha256", hash_hex(hash)}, {"expires", expires}}};
    deed.told_once = true;
    return m_desk->take(
        caller, ask, deed,
        [&](const Reader& reader, const Caller& now) -> Status {
            WEAVE_CHECK_OK(need_role(now, PersonRole::administrator));
            WEAVE_TRY(const Person person, person_named(reader, name));
            return check_an_admin_stays(reader, person.id);
        },
        [&](Writer& writer, const TakenStep& step) -> Result<Json> {
            WEAVE_TRY(Person person, person_named(writer, name));
            person.password.clear();
            person.event = step.event;
            WEAVE_CHECK_OK(writer.update_person(person));
            WEAVE_CHECK_OK(writer.end_sessions(person.id));
            WEAVE_CHECK_OK(revoke_keys(writer, person.id, step.event));
            WEAVE_CHECK_OK(
                writer.add_invitation({hash, "person", name, joined(person.roles), expires, step.event, {}}));
            return Json{{"code", code}, {"expires", expires}};
        });
}

Result<Json> Accounts::policy() {
    WEAVE_TRY(const SitePolicy policy, m_desk->store().read(policy_in_force));
    return to_json(policy);
}

Result<Json> Accounts::set_policy(const Caller& caller, const Ask& ask, const Json& policy) {
    Deed deed{"policy.set", {}, {}, Json::object()};
    return m_desk->attempt(caller, ask, deed, [&]() -> Result<Json> {
        WEAVE_TRY(const SitePolicy wanted, read_policy(policy));
        deed.data = to_json(wanted);
        return m_desk->commit(
            caller, ask, deed,
            [](const Reader&, const Caller& now) { return need_role(now, PersonRole::administrator); },
            [&](Writer& writer, const TakenStep& step) -> Result<Json> {
                WEAVE_CHECK_OK(writer.add_policy(canonical_json(to_json(wanted)), step.event));
                return to_json(wanted);
            });
    });
}

}  // namespace weave::loomlink
