#include <loomlink/service/table.hpp>

namespace weave::loomlink {

namespace {

const Field password{
    "password", "The password, typed again for this one signature", FieldKind::secret, true, 1, 1024};
const Field name{"name", "The name to sign in with", FieldKind::text, true, 1, 64};

Field roles() {
    return {"roles",
            "What the person may do",
            FieldKind::texts,
            true,
            0,
            5,
            {"designer", "approver", "operator", "engineer", "admin"}};
}

Access admin() {
    return access::only({PersonRole::administrator});
}

std::vector<ApiRoute> account_table() {
    return {
        {"login",
         "POST",
         "/login",
         access::anyone(),
         "Signs in",
         "`token`, `expires`, `csrf`, `person`; the cookie `loomlink` holds the token too",
         {},
         with_request({name, {"password", "The password", FieldKind::secret, true, 1, 1024}})},
        {"logout",
         "POST",
         "/logout",
         access::signed_in(),
         "Signs out: the token counts no more",
         "`signed_in`: false",
         {},
         with_request({})},
        {"me", "GET", "/me", access::signed_in(), "Who is signed in",
         "`person` (`name`, `full_name`, `roles`, `key`), `csrf`, `expires`"},
        {"me.waiting", "GET", "/me/waiting", access::signed_in(), "What waits for this person",
         "`items`: `design`, `revision`, `loom`, `release`, `state`, `what`, `since`"},
        {"me.password",
         "POST",
         "/me/password",
         access::signed_in(),
         "Changes the password; the signing key is sealed anew",
         "`person`",
         {},
         with_request({{"old", "The password until now", FieldKind::secret, true, 1, 1024},
                       {"new", "The password from now on", FieldKind::secret, true, 1, 1024}})},
        {"access.token",
         "POST",
         "/access-tokens",
         access::only({PersonRole::designer, PersonRole::approver, PersonRole::engineer, PersonRole::administrator}),
         "Lets the caller use simd for some hours",
         "`token`, given once, and `expires`",
         {},
         with_request({optional({"hours", "How long it is good; 8 if it is missing", FieldKind::integer, true, 1, 12})})},
        {"access.key", "GET", "/access-key", access::signed_in(), "By what simd knows the tokens of this site",
         "`site`, `key`, and `public`, the public key"},
        {"invitation.make",
         "POST",
         "/invitations",
         admin(),
         "Invites somebody",
         "`code`, given once",
         {},
         with_request({roles()})},
        {"invitation.accept",
         "POST",
         "/invitations/accept",
         access::anyone(),
         "Joins with an invitation and makes a signing key",
         "As of login",
         {},
         with_request(
             {{"code", "The code of the invitation", FieldKind::secret, true, 1, 64},
              name,
              {"full_name", "Stands beside everything that is signed", FieldKind::text, true, 1, 128},
              {"password", "Seals the signing key as well", FieldKind::secret, true, 1, 1024}})},
    };
}

std::vector<ApiRoute> members_table() {
    return {
        {"people", "GET", "/people", admin(), "All people",
         "`people`: `name`, `full_name`, `roles`, `key`, `active`"},
        {"person.roles",
         "POST",
         "/people/{name}/roles",
         admin(),
         "Sets what a person may do",
         "`person`",
         {},
         with_request({roles()})},
        {"person.disable",
         "POST",
         "/people/{name}/disable",
         admin(),
         "Lets a person sign in no more",
         "`person`",
         {},
         with_request({})},
        {"person.enable",
         "POST",
         "/people/{name}/enable",
         admin(),
         "Lets a person sign in again",
         "`person`",
         {},
         with_request({})},
        {"person.reset",
         "POST",
         "/people/{name}/reset",
         admin(),
         "Revokes a person's key and invites the person again",
         "`code`, given once",
         {},
         with_request({})},
        {"policy", "GET", "/policy", access::signed_in(), "The policy of the site",
         "The members of the policy"},
        {"policy.set",
         "PUT",
         "/policy",
         admin(),
         "Puts a policy in force",
         "The members of the policy",
         {},
         with_request(
             {{"approvals", "Different people who must approve", FieldKind::integer, true, 1, 16},
              {"release_signatures", "Different people who must sign a release", FieldKind::integer, true, 1,
               16},
              {"simulation", "Whether one is needed", FieldKind::text, true, 1, 16, {"required", "optional"}},
              {"fidelity",
               "The least that counts",
               FieldKind::text,
               true,
               1,
               16,
               {"draft", "standard", "reference"}},
              {"coverage", "Least share of the crossings that simulations cover", FieldKind::number, true, 0,
               1},
              {"index_valid_hours", "How long a loom may go on with its last index", FieldKind::integer, true,
               1, 168}})},
    };
}

std::vector<ApiRoute> key_table() {
    return {
        {"signers", "GET", "/signers", admin(), "The machines whose simulations count",
         "`signers`: `name`, `key`, `revoked`"},
        {"signer.invite",
         "POST",
         "/signers",
         admin(),
         "Lets a machine enrol whose simulations count",
         "`code`, given once",
         {},
         with_request({{"name", "What the machine is called", FieldKind::text, true, 1, 64}})},
        {"signer.enrol",
         "POST",
         "/signers/enrol",
         access::anyone(),
         "Enrols a machine's key",
         "`name`, `key`, and the `site` that it signs for",
         {},
         with_request(
             {{"code", "The code that the admin handed on", FieldKind::secret, true, 1, 64},
              {"public", "Its public key, 64 hexadecimal characters", FieldKind::text, true, 64, 64}})},
        {"signer.revoke",
         "POST",
         "/signers/{name}/revoke",
         admin(),
         "Lets a machine's key count no more",
         "`name`",
         {},
         with_request({})},
        {"trust",
         "GET",
         "/trust",
         access::signed_in(),
         "Whose keys count: the trust documents from a version on",
         "`documents`: texts, oldest first",
         {optional({"from", "The first version, from 1", FieldKind::integer, true, 1, 1 << 30})}},
        {"trust.pending", "GET", "/trust/pending", admin(), "What a next trust document would change",
         "`changes`: in words"},
        {"trust.extend",
         "POST",
         "/trust",
         admin(),
         "Signs a new trust document that lists the keys as they are now",
         "`number`, `fingerprint`",
         {},
         with_request({password, optional({"keep_server_keys",
                                           "The server's keys until now go on counting beside its new ones",
                                           FieldKind::yes_or_no})})},
    };
}

}  // namespace

std::vector<ApiRoute> people_table() {
    std::vector<ApiRoute> table = account_table();
    for (const auto& part : {members_table(), key_table()})
        table.insert(table.end(), part.begin(), part.end());
    return table;
}

}  // namespace weave::loomlink
