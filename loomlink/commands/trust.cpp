// trust and key: whose keys count for what.

#include <weave/core/file.hpp>
#include <weave/core/text.hpp>
#include <weave/keys/hex.hpp>

#include <algorithm>
#include <loomlink/commands/client_command.hpp>
#include <loomlink/commands/trust_papers.hpp>

namespace weave::loomlink {

namespace {

Status show_trust(wire::MillClient& client, const std::string& out, CommandOutcome& outcome) {
    WEAVE_TRY(const auto papers, trust_papers(client));
    if (papers.empty()) return Error{ErrorCode::refused, "nobody has signed a trust document yet", "trust"};
    WEAVE_TRY(const TrustDocument trust, read_trust(papers.back()));
    if (!out.empty()) WEAVE_CHECK_OK(write_file(out, papers.back()));
    outcome.answer({{"site", trust.site},
                    {"number", trust.version},
                    {"fingerprint", trust.fingerprint()},
                    {"issued", utc_text(trust.issued)},
                    {"keys", trust.keys.size()},
                    {"file", out.empty() ? Json(nullptr) : Json(out)}},
                   "Trust document " + std::to_string(trust.version) + " of " + on_one_line(trust.site) +
                       ", " + utc_text(trust.issued) + "\nfingerprint (SHA-256): " + trust.fingerprint() +
                       "\n");
    return {};
}

Status show_pending(wire::MillClient& client, CommandOutcome& outcome) {
    WEAVE_TRY(const Json answer, client.get("/trust/pending"));
    std::string words;
    for (const Json& change : entries(answer, "changes"))
        words += on_one_line(change.is_string() ? change.get<std::string>() : change.dump()) + "\n";
    outcome.answer(answer, words.empty() ? "The newest trust document lists the keys as they are.\n" : words);
    return {};
}

Status publish(wire::MillClient& client, const ClientWish& wish, bool keep, CommandOutcome& outcome) {
    Json body = Json::object();
    if (keep) body["keep_server_keys"] = true;
    WEAVE_TRY(const Json answer, sign_and_post(client, wish, "/trust", std::move(body)));
    outcome.answer(answer, "Trust document " + told(answer, "number") +
                               " is signed.\nfingerprint (SHA-256): " + told(answer, "fingerprint") + "\n");
    return {};
}

Json key_json(const TrustedKey& key) {
    Json roles = Json::array();
    for (const Role role : key.roles) roles.push_back(name_of(role));
    return {{"id", key.id()},
            {"public", to_hex(key.public_key)},
            {"person", key.person},
            {"roles", std::move(roles)}};
}

Status list_keys(wire::MillClient& client, CommandOutcome& outcome) {
    WEAVE_TRY(const TrustDocument trust, newest_trust_of(client));
    Json answer{{"number", trust.version}, {"keys", Json::array()}};
    std::vector<std::vector<std::string>> lines;
    for (const TrustedKey& key : trust.keys) {
        answer["keys"].push_back(key_json(key));
        lines.push_back({key.id().substr(0, 16), key.person, told(answer["keys"].back(), "roles")});
    }
    outcome.answer(answer, in_columns(lines));
    return {};
}

/// One key in full: by the first characters of its id, or the caller's own.
Status show_key(wire::MillClient& client, std::string wanted, CommandOutcome& outcome) {
    if (wanted.empty()) {
        WEAVE_TRY(const Json me, client.get("/me"));
        wanted = told(me.value("person", Json()), "key");
        if (wanted.empty()) return Error{ErrorCode::refused, "you have no signing key", "key"};
    }
    WEAVE_TRY(const TrustDocument trust, newest_trust_of(client));
    const auto fits = [&](const TrustedKey& key) { return key.id().starts_with(wanted); };
    const auto many = std::count_if(trust.keys.begin(), trust.keys.end(), fits);
    const std::string where = "trust document " + std::to_string(trust.version);
    if (many == 0)
        return Error{ErrorCode::refused, "lists no key " + wanted + ": it counts for nothing on a loom",
                     where};
    if (many > 1) return Error{ErrorCode::usage, "several keys begin so; give more of it", wanted};
    const TrustedKey& key = *std::find_if(trust.keys.begin(), trust.keys.end(), fits);
    const Json answer = key_json(key);
    outcome.answer(answer, in_columns({{"id", key.id()},
                                       {"public", to_hex(key.public_key)},
                                       {"person", key.person},
                                       {"counts for", told(answer, "roles")}}));
    return {};
}

void add_key_commands(CLI::App& app, CommandOutcome& outcome) {
    CLI::App& key = add_group(app, "key", "The keys that count, as the newest trust document lists them, and that of access tokens");
    const auto list = add_client_command(key, outcome, "list", "List them");
    on_client_run(list, outcome, [&outcome](wire::MillClient& client) { return list_keys(client, outcome); });
    const auto access = add_client_command(key, outcome, "access", "Tell the public key by which simd knows this site's access tokens");
    on_client_run(access, outcome, [&outcome](wire::MillClient& client) -> Status {
        WEAVE_TRY(const Json answer, client.get("/access-key"));
        outcome.answer(answer, in_columns({{"site", told(answer, "site")}, {"id", told(answer, "key")}, {"public", told(answer, "public")}}));
        return {};
    });
    const auto show = add_client_command(key, outcome, "show", "Tell all of one key");
    const auto wanted = std::make_shared<std::string>();
    add_text(show.command, "KEY", *wanted, "how its id begins; your own if not given");
    on_client_run(show, outcome,
                  [wanted, &outcome](wire::MillClient& client) { return show_key(client, *wanted, outcome); });
}

}  // namespace

void add_trust_commands(CLI::App& app, CommandOutcome& outcome) {
    CLI::App& trust = add_group(app, "trust", "Whose keys count: the documents that administrators sign");
    const auto show =
        add_client_command(trust, outcome, "show", "Tell the newest one, or write it to a file");
    const auto out = std::make_shared<std::string>();
    add_text(show.command, "-o,--out", *out, "the file to write, for audit verify")->type_name("FILE");
    on_client_run(show, outcome,
                  [out, &outcome](wire::MillClient& client) { return show_trust(client, *out, outcome); });
    const auto pending = add_client_command(trust, outcome, "pending", "Tell what a next one would change");
    on_client_run(pending, outcome, [&outcome](wire::MillClient& client) { return show_pending(client, outcome); });
    const auto next =
        add_client_command(trust, outcome, "publish", "Sign a new one that lists the keys as they are now",
                           "loomlink trust publish");
    add_password_option(next);
    const auto keep = std::make_shared<bool>(false);
    next.command->add_flag("--keep-server-keys", *keep,
                           "the server's keys until now go on counting beside its new ones");
    on_client_run(next, outcome, [wish = next.wish, keep, &outcome](wire::MillClient& client) {
        return publish(client, *wish, *keep, outcome);
    });
    add_key_commands(app, outcome);
}

}  // namespace weave::loomlink
