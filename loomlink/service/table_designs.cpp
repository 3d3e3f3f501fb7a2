#include <loomlink/service/table.hpp>

namespace weave::loomlink {

namespace {

constexpr std::size_t most_design_bytes = std::size_t{32} << 20;
constexpr std::size_t most_report_bytes = std::size_t{4} << 20;
constexpr std::int64_t most_number = 1 << 30;

const Field reason{"reason", "Why; it stands in the log", FieldKind::text, true, 1, 4000};
const Field password{
    "password", "The password, typed again for this one signature", FieldKind::secret, true, 1, 1024};

Access designer() {
    return access::only({PersonRole::designer});
}
Access approver() {
    return access::only({PersonRole::approver});
}

Field number(const std::string& name, const std::string& description) {
    return {name, description, FieldKind::integer, true, 1, most_number};
}

std::vector<ApiRoute> document_table() {
    return {
        {"designs", "GET", "/designs", access::readers(), "All designs",
         "`designs`: `name`, `newest` (`number`, `message`, `state`, `at`, `author`, `ends`, `picks`)"},
        {"design.make",
         "POST",
         "/designs",
         designer(),
         "Makes a design without revisions",
         "`name`",
         {},
         with_request({{"name", "Its name", FieldKind::text, true, 1, 64}})},
        {"design", "GET", "/designs/{design}", access::readers(),
         "A design: its revisions with parents and states, branches, releases",
         "`name`, `revisions`, `branches`, `releases`"},
        {"revision.save",
         "POST",
         "/designs/{design}/revisions",
         designer(),
         "Saves a revision on a branch; 409 where the branch moved on or holds this already",
         "`number`, `sha256`",
         {},
         with_request(
             {{"document", "The text of a .weave file", FieldKind::text, true, 1, most_design_bytes},
              {"branch", "The branch that it goes on", FieldKind::text, true, 1, 64},
              optional(number("expected", "The revision that it was made from, the head of the branch")),
              {"message", "What changed", FieldKind::text, true, 1, 4000},
              optional({"also", "Other parents, of a merge", FieldKind::integers, true, 0, 8})}),
         "application/json",
         2 * most_design_bytes},
        {"revision", "GET", "/designs/{design}/revisions/{n}", access::readers(),
         "A revision: its state, hashes, sizes, submission, decisions, waivers, comments, evidence, and what is missing",
         "The members that API.md names"},
        {"revision.document",
         "GET",
         "/designs/{design}/revisions/{n}/document",
         access::readers(),
         "The .weave file of a revision",
         "The file",
         {},
         {},
         "application/octet-stream"},
        {"revision.picture",
         "GET",
         "/designs/{design}/revisions/{n}/picture",
         access::readers(),
         "A picture of the cloth",
         "PNG",
         {{"view",
           "What is shown",
           FieldKind::text,
           true,
           1,
           16,
           {"card", "face", "back", "floats", "layers"}}},
         {},
         "image/png"},
        {"revision.check",
         "GET",
         "/designs/{design}/revisions/{n}/check",
         access::readers(),
         "What the rules of a loom find",
         "As `weave check --json`",
         {{"loom", "The loom", FieldKind::text, true, 1, 64}}},
        {"revision.bundle", "GET", "/designs/{design}/revisions/{n}/bundle",
         access::only({PersonRole::engineer}), "Everything about a revision, with proofs",
         "The evidence bundle"},
        {"diff",
         "GET",
         "/designs/{design}/diff",
         access::readers(),
         "In what two revisions differ",
         "As `weave diff --json`",
         {number("from", "The revision before"), number("to", "The revision after")}},
        {"diff.picture",
         "GET",
         "/designs/{design}/diff.png",
         access::readers(),
         "The cards of two revisions laid on each other",
         "PNG",
         {number("from", "The revision before"), number("to", "The revision after")},
         {},
         "image/png"},
    };
}

std::vector<ApiRoute> step_table() {
    const std::string root = "/designs/{design}/revisions/{n}";
    return {
        {"revision.submit",
         "POST",
         root + "/submit",
         designer(),
         "Submits a revision for approval",
         "`state`",
         {},
         with_request({reason,
                       optional({"looms", "The looms that it is meant for", FieldKind::texts, true, 0, 64}),
                       password})},
        {"revision.comment",
         "POST",
         root + "/comment",
         access::only({PersonRole::designer, PersonRole::approver}),
         "Comments on a revision, or on a place of its card",
         "`at`",
         {},
         with_request({{"text", "The comment", FieldKind::text, true, 1, 4000},
                       optional(number("pick", "The pick that it is about")),
                       optional(number("end", "The end that it is about"))})},
        {"revision.request-changes",
         "POST",
         root + "/request-changes",
         approver(),
         "Asks for changes",
         "`state`",
         {},
         with_request({reason, password})},
        {"revision.waive",
         "POST",
         root + "/waive",
         approver(),
         "Lets the findings of one rule for one loom pass",
         "`rule`, `loom`",
         {},
         with_request({{"rule", "As the check names it", FieldKind::text, true, 1, 64},
                       {"loom", "The loom", FieldKind::text, true, 1, 64},
                       reason,
                       password})},
        {"revision.approve",
         "POST",
         root + "/approve",
         approver(),
         "Approves exactly this revision",
         "`state`",
         {},
         with_request({reason, password})},
        {"revision.evidence",
         "POST",
         root + "/evidence",
         access::anyone(),
         "Adds what an enrolled machine's simulation found; its signature says who it is",
         "`counts`, `stale`",
         {},
         with_request({{"statement", "What was found", FieldKind::document, true, 2, 65536},
                       {"signature", "`key` and `value`, over the canonical bytes of the statement",
                        FieldKind::document, true, 2, 1024},
                       optional({"report", "The solver's report, whose hash the statement has",
                                 FieldKind::text, true, 2, most_report_bytes})}),
         "application/json",
         2 * most_report_bytes},
        {"release.make",
         "POST",
         "/releases",
         approver(),
         "Exports an approved revision for a loom, reads every file back, and signs the manifest",
         "`loom`, `number`, `state`",
         {},
         with_request({{"design", "The design", FieldKind::text, true, 1, 64},
                       number("revision", "The revision"),
                       {"loom", "The loom", FieldKind::text, true, 1, 64},
                       {"feeders", "The loom's feeder, from 1, of each of the design's", FieldKind::integers,
                        true, 0, 64},
                       optional(number("supersedes", "The release that it takes the place of")),
                       reason,
                       password})},
    };
}

}  // namespace

std::vector<ApiRoute> design_table() {
    std::vector<ApiRoute> table = document_table();
    const auto steps = step_table();
    table.insert(table.end(), steps.begin(), steps.end());
    table.push_back(card_route("revision.card", "/designs/{design}/revisions/{n}/card", access::readers()));
    return table;
}

}  // namespace weave::loomlink
