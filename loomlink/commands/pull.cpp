// pull: the loom's side takes what was released, and gives up what was recalled.

#include <weave/keys/secret_bytes.hpp>

#include <loomlink/commands/client_command.hpp>
#include <loomlink/commands/loom_watch.hpp>
#include <loomlink/commands/names.hpp>
#include <weave/wire/mill_sign_in.hpp>

namespace weave::loomlink {

namespace {

struct PullWords {
    std::string loom, to, state_file, trust;
    std::optional<std::int64_t> release, every;
    bool all = false, watch = false;
};

Result<PullWish> wish_of(const PullWords& words) {
    PullWish wish{words.loom, words.to, words.state_file, {}, words.release, words.all};
    if (words.state_file.empty()) {
        WEAVE_TRY(wish.state_file, usual_state_file(words.loom));
    }
    if (!words.trust.empty()) {
        WEAVE_TRY(wish.trust, wire::parse_fingerprint(words.trust, "--trust",
                                                "as an administrator reads them from loomlink trust show"));
    }
    if (words.release && words.all) return Error{ErrorCode::usage, "takes either --release or --all", "pull"};
    if (words.every && !words.watch) return Error{ErrorCode::usage, "goes with --watch", "--every"};
    return wish;
}

/// The password of a terminal that runs by itself, kept as long as it runs.
struct KeptPassword {
    std::string text;
    ~KeptPassword() { wipe(text); }
};

/// Signs in with the password of the file, where one was given.
Result<SignInAgain> sign_in_with(const ClientWish& client_wish, const std::string& name) {
    if (client_wish.password_file.empty()) return SignInAgain();
    PasswordSource source(client_wish.password_file);
    const auto password = std::make_shared<KeptPassword>();
    WEAVE_TRY(password->text, source.ask(""));
    WEAVE_TRY(const auto file, client_wish.session_path());
    return SignInAgain([password, file, name](wire::MillClient& client) -> Status {
        WEAVE_CHECK_OK(wire::sign_in(client, name, password->text));
        return wire::save_session(file, client.session());
    });
}

Status run_pull(wire::MillClient& client, const ClientWish& client_wish, const PullWords& words,
                CommandOutcome& outcome) {
    constexpr std::int64_t usual_seconds = 60;
    WEAVE_TRY(const PullWish wish, wish_of(words));
    WEAVE_TRY(const SignInAgain again, sign_in_with(client_wish, client.session().name));
    if (words.watch)
        return watch_loom(client, wish, std::chrono::seconds(words.every.value_or(usual_seconds)), again,
                          outcome);
    WEAVE_TRY(const PullReport report, pull_signed_in(client, wish, again));
    outcome.answer(to_json(report, wish.loom), in_words(report, wish.loom));
    if (!report.refused.empty()) outcome.fail(report.refused.front().error);
    if (!report.kept.empty()) outcome.found_something();
    return {};
}

}  // namespace

void add_pull_command(CLI::App& app, CommandOutcome& outcome) {
    const auto command =
        add_client_command(app, outcome, "pull",
                           "At the loom: fetch what is released for it, hold every byte to what people "
                           "signed, and remove what was recalled or superseded (exit 1: bytes that are not "
                           "what was signed, or such files that could not be removed; 4: recalled, expired or "
                           "replayed, or another mill than this terminal trusts)",
                           "loomlink pull 'EP 1' --to /loom --watch --password-file operator.password");
    const auto words = std::make_shared<PullWords>();
    add_loom_name(command.command, "LOOM", words->loom, "the loom")->required();
    add_text(command.command, "--to", words->to, "the folder of its releases; each gets one of its own there")
        ->type_name("FOLDER")
        ->required();
    add_number(command.command, "--release", words->release, "this one; the newest in force if not given");
    command.command->add_flag("--all", words->all, "every release that is in force");
    add_text(command.command, "--trust", words->trust,
             "the first time: the fingerprint of the site's trust document, as an administrator told it; later it "
             "changes nothing, and is refused where this terminal trusts another mill")
        ->type_name("HEX");
    add_text(command.command, "--state", words->state_file,
             "what this terminal trusts and has seen; if not given, loomlink/LOOM.json below $XDG_STATE_HOME or "
             "~/.local/state")
        ->type_name("FILE");
    command.command->add_flag("--watch", words->watch,
                              "go on for ever: pull whenever something changes, and remove what is recalled. "
                              "With --json, a line for each change");
    add_number(command.command, "--every", words->every,
               "seconds between pulls with --watch, besides; 60 if not given");
    add_password_option(command);
    on_client_run(command, outcome, [wish = command.wish, words, &outcome](wire::MillClient& client) {
        return run_pull(client, *wish, *words, outcome);
    });
}

}  // namespace weave::loomlink
