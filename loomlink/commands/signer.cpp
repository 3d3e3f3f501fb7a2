// signer: machines whose simulations count.

#include <weave/core/text.hpp>
#include <weave/keys/hex.hpp>
#include <weave/keys/server_key.hpp>
#include <weave/keys/signer.hpp>

#include <loomlink/commands/client_command.hpp>
#include <loomlink/commands/names.hpp>
#include <weave/wire/mill_sign_in.hpp>

namespace weave::loomlink {

namespace {

struct EnrolWish {
    std::string code, origin, fingerprint, key_file;
};

/// Makes the machine's key, has the server list it, and keeps which server and site it is for.
Status enrol(const ClientWish& client_wish, const EnrolWish& wish, CommandOutcome& outcome) {
    WEAVE_TRY(const auto file, client_wish.session_path());
    WEAVE_TRY(const wire::MillSession kept, wire::load_session(file));
    WEAVE_TRY(const wire::MillSession server, wire::server_wished(wish.origin, wish.fingerprint, kept));
    WEAVE_TRY(wire::MillClient client, wire::MillClient::of(server));
    WEAVE_CHECK_OK(wire::make_folders_for(wish.key_file));
    WEAVE_TRY(const KeyPair pair, create_server_key(wish.key_file, ServerKeyRole::evidence));
    const Json body{{"code", wish.code}, {"public", to_hex(pair.public_key())}};
    const auto answer = client.post("/signers/enrol", body);
    if (!answer) {
        std::error_code ignored;
        std::filesystem::remove(wish.key_file, ignored);  // a key that nobody knows
        return answer.error();
    }
    WEAVE_TRY(const std::string site, wire::text_member(*answer, "site"));
    WEAVE_TRY(const std::string name, wire::text_member(*answer, "name"));
    WEAVE_CHECK_OK(save_signer_note(wish.key_file, {pair.id(), site, name}));
    wire::MillSession session = kept.origin == server.origin ? kept : server;
    session.fingerprint = server.fingerprint;
    session.site = site;
    WEAVE_CHECK_OK(wire::save_session(file, session));
    outcome.answer(*answer, told(*answer, "name") + " is enrolled at " + on_one_line(session.site) +
                                "; its key lies in " + on_one_line(wish.key_file) + "\n");
    return {};
}

void add_enrol(CLI::App& app, CommandOutcome& outcome) {
    const auto command =
        add_client_command(app, outcome, "enrol", "On the machine itself: make its key and enrol it",
                           "loomlink signer enrol k7tq-… --server https://mill:8443 --fingerprint 4f3a… "
                           "--key-file evidence.key");
    const auto wish = std::make_shared<EnrolWish>();
    add_text(command.command, "CODE", wish->code, "the code that an administrator handed on")->required();
    add_text(command.command, "--server", wish->origin, "the server; the one of the session if not given")
        ->type_name("ORIGIN");
    add_text(command.command, "--fingerprint", wish->fingerprint, "SHA-256 of the server's certificate")
        ->type_name("HEX");
    add_text(command.command, "--key-file", wish->key_file, "the file for its key, which must not exist")
        ->type_name("FILE")
        ->required();
    on_run(command.command, outcome,
           [client = command.wish, wish, &outcome] { return enrol(*client, *wish, outcome); });
}

}  // namespace

void add_signer_commands(CLI::App& app, CommandOutcome& outcome) {
    CLI::App& signer = add_group(app, "signer", "Machines whose simulations count");
    const auto list = add_client_command(signer, outcome, "list", "List them");
    on_client_run(list, outcome, [&outcome](wire::MillClient& client) -> Status {
        WEAVE_TRY(const Json answer, client.get("/signers"));
        std::vector<std::vector<std::string>> lines;
        for (const Json& one : entries(answer, "signers"))
            lines.push_back({told(one, "name"), told(one, "key").substr(0, 16),
                             told(one, "revoked") == "true" ? "revoked" : ""});
        outcome.answer(answer, as_list(in_columns(lines)));
        return {};
    });
    const auto name = std::make_shared<std::string>();
    const auto invite = add_client_command(
        signer, outcome, "invite", "Make a code for a machine to enrol with", "loomlink signer invite gpu-1");
    add_name(invite.command, "NAME", *name, "what the machine is called")->required();
    on_client_run(invite, outcome, [name, &outcome](wire::MillClient& client) -> Status {
        WEAVE_TRY(const Json answer, client.post("/signers", {{"name", *name}}));
        outcome.answer(answer, "Enrol it with this code, once, until " + told(answer, "expires") + ": " +
                                   told(answer, "code") + "\n");
        return {};
    });
    add_enrol(signer, outcome);
    const auto revoke = add_client_command(signer, outcome, "revoke", "Let a machine's key count no more");
    add_name(revoke.command, "NAME", *name, "the machine")->required();
    on_client_run(revoke, outcome, [name, &outcome](wire::MillClient& client) -> Status {
        WEAVE_CHECK_OK(client.post(wire::mill_path({"signers", *name, "revoke"})));
        outcome.answer({{"revoked", *name}}, on_one_line(*name) + " counts no more\n");
        return {};
    });
}

}  // namespace weave::loomlink
