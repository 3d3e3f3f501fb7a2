// design, save, export, diff: revisions in and out.

#include <weave/core/file.hpp>
#include <weave/core/text.hpp>
#include <weave/design/document.hpp>
#include <weave/wire/mill_designs.hpp>

#include <cctype>
#include <fstream>

#include <loomlink/commands/client_command.hpp>
#include <loomlink/commands/names.hpp>
#include <loomlink/commands/revision_place.hpp>

namespace weave::loomlink {

namespace {

Status list_designs(wire::MillClient& client, CommandOutcome& outcome) {
    WEAVE_TRY(const Json answer, client.get("/designs"));
    std::vector<std::vector<std::string>> lines;
    for (const Json& design : entries(answer, "designs")) {
        const Json newest = design.value("newest", Json());
        lines.push_back({told(design, "name"), told(newest, "number"), told(newest, "state"),
                         told(newest, "at"), told(newest, "author"), told(newest, "message")});
    }
    outcome.answer(answer, as_list(in_columns(lines)));
    return {};
}

Status show_design(wire::MillClient& client, const std::string& design, CommandOutcome& outcome) {
    WEAVE_TRY(const Json answer, client.get(wire::mill_path({"designs", design})));
    outcome.answer(answer, in_columns(answer, "revisions",
                                      {"number", "state", "branches", "parents", "at", "author", "message"}) +
                               in_columns(answer, "releases", {"loom", "number", "state", "revision"}));
    return {};
}

/// `2026-11-26T09:30:00.000Z by Abel Miller: it is so`
std::string said(const Json& step, const std::string& words) {
    std::string place;
    for (const char* member : {"pick", "end"})
        if (const std::string number = told(step, member); !number.empty()) place += std::string(", ") + member + " " + number;
    return told(step, "at") + " by " + told(step, "by") + place + ": " + told(step, words);
}

std::string said(const Json& evidence) {
    const std::string stale = told(evidence, "stale");
    return told(evidence, "at") + " by " + told(evidence, "signer") + ": " + told(evidence, "kind") + " of " + told(evidence, "covers") +
           ": " + told(evidence, "result") + (stale.empty() ? "" : "; stale: " + stale);
}

std::string revision_words(const Json& revision) {
    std::vector<std::vector<std::string>> facts{
        {"design", told(revision, "design") + ", revision " + told(revision, "number")},
        {"state", told(revision, "state")},
        {"message", told(revision, "message")},
        {"saved", told(revision, "at") + " by " + told(revision, "author_name")},
        {"parents", told(revision, "parents")},
        {"size", told(revision, "picks") + " picks, " + told(revision, "ends") + " ends"},
        {"SHA-256", told(revision, "sha256")},
        {"you may", told(revision, "may")}};
    std::erase_if(facts, [](const std::vector<std::string>& fact) { return fact.back().empty(); });
    for (const Json& text : entries(revision, "missing"))
        facts.push_back({"missing", text.is_string() ? on_one_line(text.get<std::string>()) : text.dump()});
    if (const Json submission = revision.value("submission", Json()); submission.is_object())
        facts.push_back({"submitted", said(submission, "reason")});
    for (const Json& decision : entries(revision, "decisions")) facts.push_back({told(decision, "what"), said(decision, "reason")});
    for (const Json& waiver : entries(revision, "waivers"))
        facts.push_back({"waived", told(waiver, "rule") + " for " + told(waiver, "loom") + " by " + told(waiver, "by") + ": " +
                                       told(waiver, "reason")});
    for (const Json& comment : entries(revision, "comments")) facts.push_back({"comment", said(comment, "text")});
    for (const Json& evidence : entries(revision, "evidence")) facts.push_back({"evidence", said(evidence)});
    return in_columns(facts);
}

Status show_revision(wire::MillClient& client, const RevisionPlace& place, CommandOutcome& outcome) {
    WEAVE_TRY(const Json answer, client.get(place.path()));
    outcome.answer(answer, revision_words(answer));
    return {};
}

struct SaveWords {
    std::string file, design, branch = wire::main_branch, message;
    std::optional<std::int64_t> expected;
    std::vector<std::int64_t> also;
};

/// What is no design is told for what it is, also where it is larger than any design.
Result<std::string> read_design_file(const std::string& file) {
    auto text = read_file(file, wire::most_design_bytes);
    if (text) return text;
    std::string beginning(64, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
    beginning.resize(static_cast<std::size_t>(stream.gcount()));
    if (Status fits = check_beginning(beginning); !fits) return std::move(fits).error().in(file);
    return text;
}

Status save(wire::MillClient& client, const SaveWords& words, CommandOutcome& outcome) {
    WEAVE_TRY(std::string document, read_design_file(words.file));
    std::optional<std::int64_t> expected = words.expected;
    if (!expected) {
        WEAVE_TRY(const wire::MillHistory history, wire::history_of(client, words.design));
        expected = history.head_of(words.branch);
    }
    auto answer = wire::save_revision(client, words.design, {std::move(document), words.branch, expected, words.message, words.also});
    if (!answer && answer.error().code != ErrorCode::refused && answer.error().code != ErrorCode::system) {
        WEAVE_CHECK_OK(load_design(words.file));  // which knows a picture, or cloth, for what it is
        return std::move(answer).error().in(words.file);
    }
    if (!answer) return std::move(answer).error();
    Json json = *answer;
    json["branch"] = words.branch;
    json["expected"] = expected ? Json(*expected) : Json(nullptr);
    outcome.answer(json, on_one_line(words.design) + ": revision " + told(*answer, "number") + " on " +
                             on_one_line(words.branch) + "\n");
    return {};
}

void add_save(CLI::App& app, CommandOutcome& outcome) {
    const auto command =
        add_client_command(app, outcome, "save", "Save a .weave file as a revision of a design",
                           "loomlink save shoe.weave shoe --message 'Toe a pick longer'");
    const auto words = std::make_shared<SaveWords>();
    add_text(command.command, "FILE", words->file, "the .weave file")->required();
    add_name(command.command, "DESIGN", words->design, "the design")->required();
    add_said(command.command, "-m,--message", words->message, "what changed")->type_name("WHAT");
    add_text(command.command, "--branch", words->branch, "the branch that it goes on, main if not given; a new one starts from --expected, or from main")
        ->type_name("BRANCH");
    add_number(command.command, "--expected", words->expected,
               "the revision that it was made from: refused where the branch has moved on since. If not "
               "given, the branch as the server has it now");
    add_numbers(command.command, "--also", words->also, "other parents, of a merge");
    on_client_run(command, outcome,
                  [words, &outcome](wire::MillClient& client) { return save(client, *words, outcome); });
}

/// The document alone, or, into a folder, document and evidence bundle.
Status export_revision(wire::MillClient& client, const RevisionPlace& place, const std::string& out,
                       CommandOutcome& outcome) {
    constexpr std::size_t most_bundle = std::size_t{256} << 20;
    const std::string ending = lower_extension(out);
    if (ending.size() > 1 && std::isalpha(static_cast<unsigned char>(ending[1])) != 0 && ending != ".weave")
        return Error{ErrorCode::usage, "takes a name that ends in .weave, or a folder, and " + ending + " is the ending of neither", "--out"};
    const std::string name = place.design + "-" + std::to_string(place.revision());
    WEAVE_TRY(const std::string document, wire::document_of(client, place.design, place.revision()));
    Json files = Json::array();
    if (ending == ".weave") {
        WEAVE_CHECK_OK(write_file(out, document));
        files.push_back(out);
    } else {
        WEAVE_TRY(const std::string bundle, client.get_bytes(place.path("bundle"), most_bundle));
        const std::vector<std::pair<std::string, std::string>> content{{name + ".weave", document},
                                                                       {name + "-bundle.json", bundle}};
        WEAVE_CHECK_OK(write_folder(out, content));
        for (const auto& [file, bytes] : content)
            files.push_back((std::filesystem::path(out) / file).string());
    }
    std::string words;
    for (const Json& file : files) words += on_one_line(file.get<std::string>()) + "\n";
    outcome.answer({{"files", files}}, words);
    return {};
}

struct DiffWords {
    std::string design, out;
    std::optional<std::int64_t> before, after;
};

Status diff(wire::MillClient& client, const DiffWords& words, CommandOutcome& outcome) {
    const net::Parameters between{{"from", std::to_string(*words.before)},
                                  {"to", std::to_string(*words.after)}};
    const std::string path = wire::mill_path({"designs", words.design});
    WEAVE_TRY(Json answer, client.get(path + "/diff", between));
    if (!words.out.empty()) {
        WEAVE_TRY(const std::string picture,
                  client.get_bytes(path + "/diff.png", between, default_file_limit));
        WEAVE_CHECK_OK(write_file(words.out, picture));
        answer["file"] = words.out;
    }
    const bool equal = told(answer, "equal") == "true";
    std::string text = equal ? "The same design.\n" : "";
    for (const Json& line : entries(answer, "summary"))
        text += (line.is_string() ? on_one_line(line.get<std::string>()) : line.dump()) + "\n";
    if (!words.out.empty()) text += on_one_line(words.out) + ": the cards laid on each other\n";
    outcome.answer(answer, text);
    if (!equal) outcome.found_something();
    return {};
}

void add_diff(CLI::App& app, CommandOutcome& outcome) {
    const auto command = add_client_command(
        app, outcome, "diff", "Tell in what two revisions differ (exit 0: the same design, 1: they differ)",
        "loomlink diff shoe 3 5 -o changes.png");
    const auto words = std::make_shared<DiffWords>();
    add_name(command.command, "DESIGN", words->design, "the design")->required();
    add_number(command.command, "BEFORE", words->before, "a revision")->required();
    add_number(command.command, "AFTER", words->after, "the revision that is compared with it")->required();
    add_text(command.command, "-o,--out", words->out, "draw both cards laid on each other, as PNG")
        ->type_name("FILE");
    on_client_run(command, outcome,
                  [words, &outcome](wire::MillClient& client) { return diff(client, *words, outcome); });
}

void add_export(CLI::App& app, CommandOutcome& outcome) {
    const auto command = add_client_command(app, outcome, "export",
                                            "Write a revision: its .weave file, or a folder with it and "
                                            "everything that is known of it, with proofs",
                                            "loomlink export shoe 3 -o shoe.weave");
    const auto place = add_revision_place(command.command);
    const auto out = std::make_shared<std::string>();
    add_text(command.command, "-o,--out", *out, "a name that ends in .weave, or a folder that must not exist")
        ->type_name("FILE")
        ->required();
    on_client_run(command, outcome, [place, out, &outcome](wire::MillClient& client) {
        return export_revision(client, *place, *out, outcome);
    });
}

}  // namespace

void add_design_commands(CLI::App& app, CommandOutcome& outcome) {
    CLI::App& design = add_group(app, "design", "Designs and their revisions");
    const auto list =
        add_client_command(design, outcome, "list", "List all designs with their newest revision");
    on_client_run(list, outcome, [&outcome](wire::MillClient& client) { return list_designs(client, outcome); });
    const auto make = add_client_command(design, outcome, "make", "Make a design that has no revisions yet");
    const auto name = std::make_shared<std::string>();
    add_name(make.command, "NAME", *name, "its name")->required();
    on_client_run(make, outcome, [name, &outcome](wire::MillClient& client) -> Status {
        WEAVE_TRY(const Json answer, client.post("/designs", {{"name", *name}}));
        outcome.answer(answer, "Made the design " + on_one_line(*name) + "\n");
        return {};
    });
    const auto show = add_client_command(design, outcome, "show",
                                         "Tell the revisions of a design, or all of one revision: its state, "
                                         "decisions, evidence, and what it lacks",
                                         "loomlink design show shoe 3");
    const auto place = add_revision_place(show.command, false);
    on_client_run(show, outcome, [place, &outcome](wire::MillClient& client) {
        return place->number ? show_revision(client, *place, outcome)
                             : show_design(client, place->design, outcome);
    });
    add_save(app, outcome);
    add_export(app, outcome);
    add_diff(app, outcome);
}

}  // namespace weave::loomlink
