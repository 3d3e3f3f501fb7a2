// loom and faults: the looms of the mill, their profiles and who works at them.

#include <weave/core/file.hpp>
#include <weave/core/text.hpp>
#include <weave/loom/profile.hpp>

#include <loomlink/commands/client_command.hpp>
#include <loomlink/commands/names.hpp>

namespace weave::loomlink {

namespace {

constexpr std::uint64_t most_profile = 1 << 20;

Status list_looms(wire::MillClient& client, CommandOutcome& outcome) {
    WEAVE_TRY(const Json answer, client.get("/looms"));
    std::vector<std::vector<std::string>> lines;
    for (const Json& loom : entries(answer, "looms"))
        lines.push_back({told(loom, "name"), told(loom, "profile_name"), told(loom, "released") + " released",
                         told(loom, "loaded").empty() ? "" : "loaded: " + told(loom, "loaded")});
    outcome.answer(answer, as_list(in_columns(lines)));
    return {};
}

Status show_loom(wire::MillClient& client, const std::string& name, CommandOutcome& outcome) {
    WEAVE_TRY(const Json answer, client.get(wire::mill_path({"looms", name})));
    outcome.answer(answer, in_columns({{"loom", told(answer, "name")},
                                       {"profile", told(answer, "profile_name") + ", version " +
                                                       told(answer, "profile_version")},
                                       {"profile SHA-256", told(answer, "profile_sha256")},
                                       {"hooks", told(answer, "hooks")},
                                       {"feeders", told(answer, "feeders")},
                                       {"takes", told(answer, "output")},
                                       {"operators", told(answer, "operators")},
                                       {"loaded", told(answer, "loaded")}}) +
                               "\n" +
                               in_columns(answer, "releases",
                                          {"number", "state", "design", "revision", "at", "by", "reason"}));
    return {};
}

struct ProfileWish {
    std::string loom, file;
};

/// Adds a loom, or puts a new version of its profile in force.
Status send_profile(wire::MillClient& client, const ProfileWish& wish, bool is_new, CommandOutcome& outcome) {
    WEAVE_TRY(std::string profile, read_file(wish.file, most_profile));
    Json body{{"profile", std::move(profile)}};
    if (is_new) body["name"] = wish.loom;
    auto answer = is_new ? client.post("/looms", std::move(body))
                         : client.change("PUT", wire::mill_path({"looms", wish.loom, "profile"}), std::move(body));
    if (!answer && answer.error().code != ErrorCode::refused && answer.error().code != ErrorCode::system) {
        WEAVE_CHECK_OK(load_profile(wish.file));  // which knows a picture, or a design, for what it is
        return std::move(answer).error().in(wish.file);
    }
    if (!answer) return std::move(answer).error();
    outcome.answer(*answer, on_one_line(wish.loom) + ": profile version " + told(*answer, "profile_version") +
                                " is in force\n");
    return {};
}

void add_profile_command(CLI::App& app, CommandOutcome& outcome, bool is_new) {
    const auto command =
        is_new
            ? add_client_command(app, outcome, "add", "Add a loom", "loomlink loom add 'EP 1' ep-2688.json")
            : add_client_command(app, outcome, "profile",
                                 "Put a new version of its profile in force; what was released for the "
                                 "version before has to be released again");
    const auto wish = std::make_shared<ProfileWish>();
    add_loom_name(command.command, "LOOM", wish->loom, "the loom's name")->required();
    add_text(command.command, "FILE", wish->file, "its profile, a .json file (weave: PROFILE.md)")
        ->required();
    on_client_run(command, outcome, [wish, is_new, &outcome](wire::MillClient& client) {
        return send_profile(client, *wish, is_new, outcome);
    });
}

Status list_faults(wire::MillClient& client, const std::string& loom, CommandOutcome& outcome) {
    WEAVE_TRY(const Json answer, client.get(wire::mill_path({"looms", loom, "faults"})));
    std::vector<std::vector<std::string>> lines;
    for (const Json& fault : entries(answer, "faults")) {
        const auto place = [&](const char* what) {
            return told(fault, what).empty() ? std::string() : std::string(what) + " " + told(fault, what);
        };
        lines.push_back({told(fault, "at"), "release " + told(fault, "release"), place("pick"), place("end"),
                         told(fault, "by"), told(fault, "text")});
    }
    outcome.answer(answer, as_list(in_columns(lines)));
    return {};
}

}  // namespace

void add_loom_commands(CLI::App& app, CommandOutcome& outcome) {
    CLI::App& loom = add_group(app, "loom", "Looms: profiles, operators, releases");
    const auto list = add_client_command(loom, outcome, "list", "List the looms that are open to you");
    on_client_run(list, outcome, [&outcome](wire::MillClient& client) { return list_looms(client, outcome); });
    const auto name = std::make_shared<std::string>();
    const auto show = add_client_command(loom, outcome, "show", "Tell all of a loom and its releases");
    add_loom_name(show.command, "LOOM", *name, "the loom")->required();
    on_client_run(show, outcome,
                  [name, &outcome](wire::MillClient& client) { return show_loom(client, *name, outcome); });
    add_profile_command(loom, outcome, true);
    add_profile_command(loom, outcome, false);
    const auto operators =
        add_client_command(loom, outcome, "operators", "Say who works at a loom; nobody else then",
                           "loomlink loom operators 'EP 1' otto olga");
    const auto people = std::make_shared<std::vector<std::string>>();
    add_loom_name(operators.command, "LOOM", *name, "the loom")->required();
    operators.command->add_option("NAME", *people, "operators; nobody if none is given")->type_name("");
    on_client_run(operators, outcome, [name, people, &outcome](wire::MillClient& client) -> Status {
        WEAVE_TRY(const Json answer,
                  client.change("PUT", wire::mill_path({"looms", *name, "operators"}), {{"operators", *people}}));
        outcome.answer(answer, on_one_line(*name) + ": " + told(answer, "operators") + "\n");
        return {};
    });
    const auto faults =
        add_client_command(app, outcome, "faults", "List the faults that a loom's operators reported");
    add_loom_name(faults.command, "LOOM", *name, "the loom")->required();
    on_client_run(faults, outcome,
                  [name, &outcome](wire::MillClient& client) { return list_faults(client, *name, outcome); });
}

}  // namespace weave::loomlink
