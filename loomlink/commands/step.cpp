// submit, comment, request-changes, waive, approve, check: the way of a revision to its approval.

#include <weave/core/text.hpp>
#include <weave/wire/mill_designs.hpp>

#include <loomlink/commands/client_command.hpp>
#include <loomlink/commands/evidence_file.hpp>
#include <loomlink/commands/names.hpp>
#include <loomlink/commands/revision_place.hpp>

namespace weave::loomlink {

namespace {

struct StepWords {
    std::string reason, rule, loom;
    std::vector<std::string> looms, evidence;
    std::optional<std::int64_t> pick, end;
};

/// A step that is signed, with DESIGN, REVISION and --reason.
struct SignedStep {
    ClientCommand client;
    std::shared_ptr<RevisionPlace> place;
    std::shared_ptr<StepWords> words;
};

SignedStep add_signed_step(CLI::App& app, CommandOutcome& outcome, const std::string& name,
                           const std::string& help, const std::string& example) {
    SignedStep step{add_client_command(app, outcome, name, help, example), nullptr,
                    std::make_shared<StepWords>()};
    step.place = add_revision_place(step.client.command);
    add_reason(step.client.command, step.words->reason);
    add_password_option(step.client);
    return step;
}

/// What a person is told of a step that was done: the revision's new state, if nothing else matters.
std::string state_told(const Json& answer, const StepWords&) {
    const std::string state = told(answer, "state");
    if (!answer.contains("approvals_needed")) return state;
    return "approved by " + told(answer, "approvals") + " of " + told(answer, "approvals_needed") +
           " people; still " + state;
}

void on_signed_step(const SignedStep& step, CommandOutcome& outcome, const std::string& below,
                    std::function<Json(const StepWords&)> body_of,
                    std::function<std::string(const Json&, const StepWords&)> done_words = state_told) {
    on_client_run(
        step.client, outcome,
        [=, wish = step.client.wish, place = step.place, words = step.words, body_of = std::move(body_of),
         done_words = std::move(done_words), &outcome](wire::MillClient& client) -> Status {
            WEAVE_TRY(const Json answer, sign_and_post(client, *wish, place->path(below), body_of(*words)));
            outcome.answer(answer, place->words() + ": " + done_words(answer, *words) + "\n");
            return {};
        });
}

/// Submits a revision; first files the evidence that comes with it, all of which is read before any is filed.
Status submit(wire::MillClient& client, const ClientWish& wish, const RevisionPlace& place, const StepWords& words,
              CommandOutcome& outcome) {
    std::vector<EvidenceToFile> papers;
    for (const std::string& file : words.evidence) {
        WEAVE_TRY(EvidenceToFile paper, load_evidence(file));
        papers.push_back(std::move(paper));
    }
    std::string filed_words;
    Json filed = Json::array();
    for (const EvidenceToFile& paper : papers) {
        WEAVE_TRY(Json number, wire::file_evidence(client, place.design, place.revision(), paper.evidence));
        filed.push_back(std::move(number));
        filed_words += place.words() + ": " + paper.words() + "\n";
    }
    WEAVE_TRY(std::string password, password_to_sign(client, wish));
    WEAVE_TRY(Json answer, wire::submit_revision(client, place.design, place.revision(), words.reason, words.looms, std::move(password)));
    if (!papers.empty()) answer["evidence_filed"] = std::move(filed);
    outcome.answer(answer, filed_words + place.words() + ": " + state_told(answer, words) + "\n");
    return {};
}

void add_submit(CLI::App& app, CommandOutcome& outcome) {
    const auto step = add_signed_step(app, outcome, "submit", "Submit a revision for approval",
                                      "loomlink submit shoe 3 --reason 'Ready to weave' --loom 'EP 1'");
    step.client.command
        ->add_option("--evidence", step.words->evidence,
                     "what a machine signed that it found, to be filed first; may be repeated")
        ->allow_extra_args(false)
        ->type_name("FILE");
    step.client.command
        ->add_option("--loom", step.words->looms,
                     "a loom that it is meant for; may be repeated; all if not given")
        ->check(loom_name())
        ->allow_extra_args(false)
        ->type_name("LOOM");
    on_client_run(step.client, outcome, [step, &outcome](wire::MillClient& client) {
        return submit(client, *step.client.wish, *step.place, *step.words, outcome);
    });
}

void add_waive(CLI::App& app, CommandOutcome& outcome) {
    const auto step =
        add_signed_step(app, outcome, "waive", "Let the findings of one rule for one loom pass",
                        "loomlink waive shoe 3 --rule float.back --loom 'EP 1' --reason 'Wanted'");
    add_text(step.client.command, "--rule", step.words->rule, "the rule, as check names it")
        ->type_name("RULE")
        ->required();
    add_loom_name(step.client.command, "--loom", step.words->loom, "the loom")->required();
    const auto body_of = [](const StepWords& words) {
        return Json{{"rule", words.rule}, {"loom", words.loom}, {"reason", words.reason}};
    };
    on_signed_step(step, outcome, "waive", body_of, [](const Json&, const StepWords& words) {
        return on_one_line(words.rule) + " waived for " + on_one_line(words.loom);
    });
}

void add_decisions(CLI::App& app, CommandOutcome& outcome) {
    const auto reason_alone = [](const StepWords& words) { return Json{{"reason", words.reason}}; };
    const auto approve = add_signed_step(app, outcome, "approve", "Approve exactly this revision",
                                         "loomlink approve shoe 3 --reason 'Looked at face, floats and toe'");
    on_signed_step(approve, outcome, "approve", reason_alone);
    const auto changes = add_signed_step(app, outcome, "request-changes", "Ask for changes",
                                         "loomlink request-changes shoe 3 --reason 'The toe floats'");
    on_signed_step(changes, outcome, "request-changes", reason_alone);
}

void add_comment(CLI::App& app, CommandOutcome& outcome) {
    const auto command =
        add_client_command(app, outcome, "comment", "Comment on a revision, or on a place of its card",
                           "loomlink comment shoe 3 'Is this float wanted?' --pick 120 --end 7");
    const auto place = add_revision_place(command.command);
    const auto words = std::make_shared<StepWords>();
    add_said(command.command, "TEXT", words->reason, "the comment");
    add_number(command.command, "--pick", words->pick, "the pick that it is about");
    add_number(command.command, "--end", words->end, "the end that it is about");
    on_client_run(command, outcome, [place, words, &outcome](wire::MillClient& client) -> Status {
        WEAVE_TRY(const Json answer,
                  wire::comment_on(client, place->design, place->revision(), words->reason, words->pick, words->end));
        outcome.answer(answer, place->words() + ": the comment stands\n");
        return {};
    });
}

Status check(wire::MillClient& client, const RevisionPlace& place, const std::string& loom,
             CommandOutcome& outcome) {
    WEAVE_TRY(const Json answer, client.get(place.path("check"), {{"loom", loom}}));
    outcome.answer(answer, in_columns(answer, "findings", {"severity", "rule", "message"}) +
                               in_columns(answer, "not_evaluated", {"rule", "reason"}) + "On " +
                               on_one_line(loom) + ": errors " + told(answer, "errors") + ", warnings " +
                               told(answer, "warnings") + "\n");
    if (told(answer, "errors") != "0") outcome.found_something();
    return {};
}

void add_check(CLI::App& app, CommandOutcome& outcome) {
    const auto command = add_client_command(
        app, outcome, "check", "Hold a revision to a loom; exit status 1 where a rule finds an error",
        "loomlink check shoe 3 --loom 'EP 1'");
    const auto place = add_revision_place(command.command);
    const auto loom = std::make_shared<std::string>();
    add_loom_name(command.command, "--loom", *loom, "the loom")->required();
    on_client_run(command, outcome, [place, loom, &outcome](wire::MillClient& client) {
        return check(client, *place, *loom, outcome);
    });
}

}  // namespace

void add_step_commands(CLI::App& app, CommandOutcome& outcome) {
    add_check(app, outcome);
    add_submit(app, outcome);
    add_comment(app, outcome);
    add_decisions(app, outcome);
    add_waive(app, outcome);
}

}  // namespace weave::loomlink
