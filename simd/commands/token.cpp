// token: who may come in where no loomlink gives out tokens.

#include <weave/command/serving.hpp>
#include <weave/core/text.hpp>

#include <filesystem>
#include <memory>
#include <simd/commands/command.hpp>
#include <simd/commands/running_daemon.hpp>
#include <simd/service/local_tokens.hpp>

namespace weave::simd {

namespace {

struct TokenWords {
    std::string folder, person;
};

CLI::App* add_token_command(CLI::App& group, CommandOutcome& outcome, const char* name, const char* help, const std::shared_ptr<TokenWords>& words,
                            bool of_person) {
    CLI::App* const command = add_command(group, outcome, name, help);
    command->add_option("FOLDER", words->folder, "the folder of the daemon")->required();
    if (of_person) command->add_option("person", words->person, "the name by which the daemon knows the person")->required();
    return command;
}

Status list(const TokenWords& words, CommandOutcome& outcome) {
    WEAVE_TRY(const auto people, read_local_tokens(DaemonFolder{words.folder}.tokens()));
    Json names = Json::array();
    std::string text;
    for (const auto& [hash, person] : people) {
        names.push_back(person);
        text += person + "\n";
    }
    outcome.answer({{"people", std::move(names)}}, text.empty() ? "nobody has a token\n" : text);
    return {};
}

}  // namespace

void add_token_commands(CLI::App& app, CommandOutcome& outcome) {
    CLI::App& group = *app.add_subcommand("token", "Who may come in, beside those whom loomlink gives a token")->group("Commands");
    group.require_subcommand(1);
    const auto words = std::make_shared<TokenWords>();
    on_run(add_token_command(group, outcome, "add", "Make a token for a person, in place of an earlier one; it is told once", words, true), outcome,
           [words, &outcome]() -> Status {
               std::error_code unknown;
               const bool is_new = !std::filesystem::exists(words->folder, unknown);
               WEAVE_CHECK_OK(make_service_folder(words->folder));
               if (is_new) outcome.note(on_one_line(words->folder) + ": made; no daemon has served there yet");
               WEAVE_TRY(const std::string token, add_local_token(DaemonFolder{words->folder}.tokens(), words->person));
               outcome.answer({{"person", words->person}, {"token", token}}, token + "\n");
               return {};
           });
    on_run(add_token_command(group, outcome, "remove", "Take a person's token away", words, true), outcome, [words, &outcome]() -> Status {
        WEAVE_CHECK_OK(remove_local_token(DaemonFolder{words->folder}.tokens(), words->person));
        outcome.answer({{"removed", words->person}}, words->person + " has no token any more\n");
        return {};
    });
    on_run(add_token_command(group, outcome, "list", "Tell who has one", words, false), outcome, [words, &outcome] { return list(*words, outcome); });
}

}  // namespace weave::simd
