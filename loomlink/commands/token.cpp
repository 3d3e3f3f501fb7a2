// token: what lets a person use simd for some hours.

#include <weave/core/text.hpp>
#include <weave/keys/private_file.hpp>
#include <weave/keys/secret_bytes.hpp>

#include <loomlink/commands/client_command.hpp>

namespace weave::loomlink {

namespace {

struct TokenWish {
    std::optional<std::int64_t> hours;
    std::string out;
};

Status get_token(wire::MillClient& client, const TokenWish& wish, CommandOutcome& outcome) {
    Json body = Json::object();
    if (wish.hours) body["hours"] = *wish.hours;
    WEAVE_TRY(const Json answer, client.post("/access-tokens", std::move(body)));
    WEAVE_TRY(std::string token, wire::text_member(answer, "token"));
    WEAVE_TRY(const std::string expires, wire::text_member(answer, "expires"));
    if (wish.out.empty()) {
        outcome.answer(answer, on_one_line(token) + "\n");
        wipe(token);
        return {};
    }
    Status written = write_private_file(wish.out, token + "\n");
    wipe(token);
    WEAVE_CHECK_OK(written);
    outcome.answer({{"file", wish.out}, {"expires", expires}},
                   on_one_line(wish.out) + ": good until " + on_one_line(expires) + "\n");
    return {};
}

}  // namespace

void add_token_command(CLI::App& app, CommandOutcome& outcome) {
    const auto command = add_client_command(
        app, outcome, "token", "Get what lets you use simd for some hours; it cannot be called back, so keep it to yourself",
        "loomlink token -o simd.token");
    const auto wish = std::make_shared<TokenWish>();
    add_number(command.command, "--hours", wish->hours, "how long it is good, at most 12; 8 if nothing is said");
    add_text(command.command, "-o,--out", wish->out,
             "the file to write, for nobody else to read; if not given, the token is told")
        ->type_name("FILE");
    on_client_run(command, outcome,
                  [wish, &outcome](wire::MillClient& client) { return get_token(client, *wish, outcome); });
}

}  // namespace weave::loomlink
