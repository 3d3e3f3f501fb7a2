// release, sign, withdraw: what may go to a loom, and what may no longer.

#include <weave/core/text.hpp>

#include <loomlink/commands/client_command.hpp>
#include <loomlink/commands/names.hpp>
#include <loomlink/commands/revision_place.hpp>

namespace weave::loomlink {

namespace {

struct ReleaseWords {
    std::string loom, reason;
    std::vector<std::int64_t> feeders;
    std::optional<std::int64_t> supersedes;
};

/// Each of the design's feeders on the loom's of the same number.
Result<std::vector<std::int64_t>> straight_feeders(wire::MillClient& client, const RevisionPlace& place) {
    WEAVE_TRY(const Json revision, client.get(place.path()));
    std::vector<std::int64_t> feeders;
    for (std::size_t k = 0; k < entries(revision, "feeders").size(); ++k)
        feeders.push_back(static_cast<std::int64_t>(k) + 1);
    return feeders;
}

Status release(wire::MillClient& client, const ClientWish& wish, const RevisionPlace& place, ReleaseWords words,
               CommandOutcome& outcome) {
    if (words.feeders.empty()) {
        WEAVE_TRY(words.feeders, straight_feeders(client, place));
    }
    Json body{{"design", place.design},
              {"revision", place.revision()},
              {"loom", words.loom},
              {"feeders", words.feeders},
              {"reason", words.reason}};
    if (words.supersedes) body["supersedes"] = *words.supersedes;
    WEAVE_TRY(const Json answer, sign_and_post(client, wish, "/releases", std::move(body)));
    const bool waits = told(answer, "state") == "awaiting";
    outcome.answer(
        answer, "Release " + told(answer, "number") + " for " + told(answer, "loom") + ": " +
                    (waits ? "waits for another signature (loomlink sign)" : told(answer, "state")) + "\n");
    return {};
}

void add_release(CLI::App& app, CommandOutcome& outcome) {
    const auto command = add_client_command(
        app, outcome, "release",
        "Export an approved revision for a loom, have every file read back, and sign it",
        "loomlink release shoe 3 --loom 'EP 1' --feeders 2,1 --supersedes 4 --reason 'For the spring order'");
    const auto place = add_revision_place(command.command);
    const auto words = std::make_shared<ReleaseWords>();
    add_loom_name(command.command, "--loom", words->loom, "the loom")->required();
    add_numbers(command.command, "--feeders", words->feeders,
                "the loom's feeder of each of the design's; 1,2,3 … if not given");
    add_number(command.command, "--supersedes", words->supersedes,
               "the release of this design that the loom has now, which this one takes the place of");
    add_said(command.command, "-r,--reason", words->reason, "why; it stands in the log");
    add_password_option(command);
    on_client_run(command, outcome, [wish = command.wish, place, words, &outcome](wire::MillClient& client) {
        return release(client, *wish, *place, *words, outcome);
    });
}

struct ReleasePlace {
    std::string loom, reason;
    std::optional<std::int64_t> number;
};

void add_step(CLI::App& app, CommandOutcome& outcome, const std::string& step, const std::string& help,
              const std::string& example) {
    const auto command = add_client_command(app, outcome, step, help, example);
    const auto place = std::make_shared<ReleasePlace>();
    add_loom_name(command.command, "LOOM", place->loom, "the loom")->required();
    add_number(command.command, "RELEASE", place->number, "the number of its release")->required();
    add_said(command.command, "-r,--reason", place->reason, "why; it stands in the log");
    add_password_option(command);
    on_client_run(
        command, outcome, [wish = command.wish, place, step, &outcome](wire::MillClient& client) -> Status {
            const std::string path =
                wire::mill_path({"looms", place->loom, "releases", std::to_string(*place->number), step});
            WEAVE_TRY(const Json answer, sign_and_post(client, *wish, path, {{"reason", place->reason}}));
            outcome.answer(answer, on_one_line(place->loom) + ", release " + std::to_string(*place->number) +
                                       ": " + told(answer, "state") + "\n");
            return {};
        });
}

}  // namespace

void add_release_commands(CLI::App& app, CommandOutcome& outcome) {
    add_release(app, outcome);
    add_step(app, outcome, "sign", "Sign a release that waits for another signature",
             "loomlink sign 'EP 1' 5 --reason 'Looked at the files'");
    add_step(app, outcome, "withdraw", "Recall a release: no loom may weave it any more",
             "loomlink withdraw 'EP 1' 5 --reason 'Wrong yarn in feeder 2'");
}

}  // namespace weave::loomlink
