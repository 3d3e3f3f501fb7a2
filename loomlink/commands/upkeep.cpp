// verify, backup, restore: a site as files, on the machine that serves it.

#include <weave/core/text.hpp>

#include <loomlink/commands/command.hpp>
#include <loomlink/commands/finding_words.hpp>
#include <loomlink/commands/head_keeper.hpp>
#include <loomlink/commands/site_copy.hpp>
#include <loomlink/commands/site_restore.hpp>
#include <memory>

namespace weave::loomlink {

namespace {

Status verify(const std::string& folder, const std::string& retained_file, CommandOutcome& outcome) {
    std::optional<SignedTreeHead> retained;
    if (!retained_file.empty()) {
        WEAVE_TRY(retained, load_retained_head(retained_file));
    }
    WEAVE_TRY(const auto findings, verify_site({folder}, retained));
    outcome.answer({{"clean", findings.empty()},
                    {"retained", retained.has_value()},
                    {"findings", findings_json(findings)}},
                   findings.empty() ? on_one_line(folder) + ": everything is as it was written\n"
                                    : findings_words(findings));
    if (!findings.empty()) outcome.found_something();
    return {};
}

void add_verify(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* const command = add_command(app, outcome, "verify",
                                          "Look at everything a site keeps once more: pages, objects, "
                                          "records, signatures, keys, and whether every table says what the log tells; also "
                                          "while it is served. Exit status 1 where something is not as it was written",
                                          "loomlink verify /srv/mill --retained head.json");
    const auto folder = std::make_shared<std::string>();
    const auto retained = std::make_shared<std::string>();
    add_text(command, "FOLDER", *folder, "the folder of the site")->required();
    add_text(command, "--retained", *retained,
             "a head kept from earlier, as audit head -o wrote it or the server in a second place: a log that was "
             "rewritten is found out")
        ->type_name("FILE");
    on_run(command, outcome, [folder, retained, &outcome] { return verify(*folder, *retained, outcome); });
}

struct RestoreWords {
    std::string from, to;
    bool may_replace = false;
};

Status restore(const RestoreWords& words, CommandOutcome& outcome) {
    WEAVE_TRY(const auto replaced, restore_site({words.from}, {words.to}, words.may_replace));
    Json answer{{"folder", words.to}};
    std::string told = on_one_line(words.to) + ": the site as it was. ";
    if (replaced) {
        answer["replaced"] = replaced->string();
        told += "What was there is kept as " + on_one_line(replaced->string()) + ". ";
    }
    outcome.answer(answer, told + "Looms refuse a log that is shorter than they have seen: see loomlink/commands/README.md\n");
    return {};
}

void add_restore(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* const command = add_command(
        app, outcome, "restore",
        "Put a backup into place, after verifying it; the site must not be served. What was the store there stays beside it as "
        "loomlink.db.replaced. Refused where its log has records that the backup has not, or is another site's, unless --replace",
        "loomlink restore /backup/mill-monday /srv/mill");
    const auto words = std::make_shared<RestoreWords>();
    add_text(command, "FROM", words->from, "the folder that backup made")->required();
    add_text(command, "FOLDER", words->to, "the folder of the site: missing, empty, or the site to put back")->required();
    command->add_flag("--replace", words->may_replace,
                      "also where work since the backup is lost with it, or another site; of another site the keys are set aside too "
                      "(log.key.replaced …)");
    on_run(command, outcome, [words, &outcome] { return restore(*words, outcome); });
}

}  // namespace

void add_upkeep_commands(CLI::App& app, CommandOutcome& outcome) {
    add_verify(app, outcome);
    const auto from = std::make_shared<std::string>();
    const auto to = std::make_shared<std::string>();
    CLI::App* const backup = add_command(
        app, outcome, "backup",
        "Copy a site into a new folder, also while it is served. It holds the server's keys: keep it as "
        "safe as the site itself",
        "loomlink backup /srv/mill /backup/mill-monday");
    add_text(backup, "FOLDER", *from, "the folder of the site")->required();
    add_text(backup, "TO", *to, "the folder to make")->required();
    on_run(backup, outcome, [from, to, &outcome]() -> Status {
        WEAVE_CHECK_OK(back_up_site({*from}, *to));
        outcome.answer({{"folder", *to}}, on_one_line(*to) + ": the site as it is now\n");
        return {};
    });
    add_restore(app, outcome);
}

}  // namespace weave::loomlink
