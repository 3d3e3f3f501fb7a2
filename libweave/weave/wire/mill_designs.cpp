#include <weave/wire/mill_designs.hpp>

#include <weave/keys/secret_bytes.hpp>

#include <algorithm>
#include <utility>

namespace weave::wire {

namespace {

/// What an answer may leave out is read here, whatever stands in its place.
const Json& member(const Json& json, const char* name) {
    static const Json nothing;
    if (!json.is_object()) return nothing;
    const auto found = json.find(name);
    return found == json.end() ? nothing : *found;
}

std::string text(const Json& json, const char* name) {
    const Json& found = member(json, name);
    return found.is_string() ? found.get<std::string>() : std::string();
}

std::optional<std::int64_t> number(const Json& json, const char* name) {
    const Json& found = member(json, name);
    return found.is_number_integer() ? std::optional(found.get<std::int64_t>()) : std::nullopt;
}

std::vector<std::string> texts(const Json& json, const char* name) {
    std::vector<std::string> list;
    for (const Json& entry : member(json, name))
        if (entry.is_string()) list.push_back(entry.get<std::string>());
    return list;
}

/// The entries of a list that it must have.
template <class Entry, class Read>
Result<std::vector<Entry>> entries(const Json& json, const char* name, Read read) {
    const Json& list = member(json, name);
    if (!list.is_array()) return bad_input("the server's answer lacks it", name);
    std::vector<Entry> made;
    for (const Json& entry : list) {
        WEAVE_TRY(Entry one, read(entry));
        made.push_back(std::move(one));
    }
    return made;
}

Result<MillDesign> read_design(const Json& json) {
    MillDesign design;
    WEAVE_TRY(design.name, text_member(json, "name"));
    const Json& newest = member(json, "newest");
    design.newest = number(newest, "number");
    design.state = text(newest, "state");
    return design;
}

Result<MillBranch> read_branch(const Json& json) {
    MillBranch branch;
    WEAVE_TRY(branch.name, text_member(json, "name"));
    WEAVE_TRY(branch.head, number_member(json, "head"));
    return branch;
}

Result<MillRevision> read_revision(const Json& json) {
    MillRevision revision;
    WEAVE_TRY(revision.number, number_member(json, "number"));
    WEAVE_TRY(revision.state, text_member(json, "state"));
    revision.author = text(json, "author");
    revision.at = text(json, "at");
    revision.message = text(json, "message");
    return revision;
}

Result<MillRelease> read_release(const Json& json) {
    MillRelease release;
    WEAVE_TRY(release.loom, text_member(json, "loom"));
    WEAVE_TRY(release.number, number_member(json, "number"));
    WEAVE_TRY(release.revision, number_member(json, "revision"));
    release.state = text(json, "state");
    return release;
}

Result<MillDecision> read_decision(const Json& json) {
    return MillDecision{text(json, "what"), text(json, "by"), text(json, "at"), text(json, "reason")};
}

Result<MillComment> read_comment(const Json& json) {
    return MillComment{text(json, "by"), text(json, "at"), text(json, "text"), number(json, "pick"), number(json, "end")};
}

Result<MillEvidence> read_paper(const Json& json) {
    return MillEvidence{text(json, "kind"),   text(json, "covers"), text(json, "result"),
                        text(json, "signer"), text(json, "at"),     text(json, "stale")};
}

std::string design_path(const std::string& design) {
    return mill_path({"designs", design});
}

}  // namespace

Result<MillPerson> who_am_i(MillClient& client) {
    WEAVE_TRY(const Json answer, client.get("/me"));
    const Json& person = member(answer, "person");
    MillPerson made;
    WEAVE_TRY(made.name, text_member(person, "name"));
    made.full_name = text(person, "full_name");
    made.roles = texts(person, "roles");
    return made;
}

Result<std::vector<MillDesign>> list_designs(MillClient& client) {
    WEAVE_TRY(const Json answer, client.get("/designs"));
    return entries<MillDesign>(answer, "designs", read_design);
}

Status make_design(MillClient& client, const std::string& name) {
    const auto answer = client.post("/designs", {{"name", name}});
    return answer ? Status() : Status(answer.error());
}

std::optional<std::int64_t> MillHistory::head_of(const std::string& branch) const {
    for (const std::string& name : {branch, std::string(main_branch)})
        for (const MillBranch& one : branches)
            if (one.name == name) return one.head;
    return {};
}

Result<MillHistory> history_of(MillClient& client, const std::string& design) {
    WEAVE_TRY(const Json answer, client.get(design_path(design)));
    MillHistory history;
    history.design = design;
    WEAVE_TRY(history.branches, entries<MillBranch>(answer, "branches", read_branch));
    WEAVE_TRY(history.revisions, entries<MillRevision>(answer, "revisions", read_revision));
    WEAVE_TRY(history.releases, entries<MillRelease>(answer, "releases", read_release));
    return history;
}

bool MillReview::allows(const std::string& action) const {
    return std::find(may.begin(), may.end(), action) != may.end();
}

Result<MillReview> review_of(MillClient& client, const std::string& design, std::int64_t number_of_it) {
    WEAVE_TRY(const Json answer, client.get(revision_path(design, number_of_it)));
    MillReview review;
    review.design = design;
    WEAVE_TRY(review.revision, read_revision(answer));
    if (const std::string name = text(answer, "author_name"); !name.empty()) review.revision.author = name;
    review.picks = number(answer, "picks").value_or(0);
    review.ends = number(answer, "ends").value_or(0);
    review.design_sha256 = text(answer, "design_sha256");
    review.scene_sha256 = text(answer, "scene_sha256");
    review.document_sha256 = text(answer, "document_sha256");
    review.missing = texts(answer, "missing");
    review.may = texts(answer, "may");
    if (const Json step = answer.value("submission", Json()); step.is_object())
        review.submission = MillDecision{"submitted", text(step, "by"), text(step, "at"), text(step, "reason")};
    WEAVE_TRY(review.decisions, entries<MillDecision>(answer, "decisions", read_decision));
    WEAVE_TRY(review.comments, entries<MillComment>(answer, "comments", read_comment));
    WEAVE_TRY(review.evidence, entries<MillEvidence>(answer, "evidence", read_paper));
    return review;
}

std::string revision_path(const std::string& design, std::int64_t number) {
    return mill_path({"designs", design, "revisions", std::to_string(number)});
}

Result<std::string> document_of(MillClient& client, const std::string& design, std::int64_t number) {
    return client.get_bytes(revision_path(design, number) + "/document", most_design_bytes);
}

Result<Json> save_revision(MillClient& client, const std::string& design, RevisionToSave wish) {
    Json body{{"document", std::move(wish.document)}, {"branch", wish.branch}, {"message", wish.message}};
    if (wish.expected) body["expected"] = *wish.expected;
    if (!wish.also.empty()) body["also"] = wish.also;
    return client.post(design_path(design) + "/revisions", std::move(body));
}

Result<Json> file_evidence(MillClient& client, const std::string& design, std::int64_t number, const SignedEvidence& evidence) {
    WEAVE_TRY(const Json answer,
              client.post(revision_path(design, number) + "/evidence",
                          {{"statement", evidence.statement},
                           {"signature", {{"key", evidence.signature.key}, {"value", evidence.signature.value}}},
                           {"report", evidence.report}}));
    return member(answer, "evidence");
}

Result<Json> submit_revision(MillClient& client, const std::string& design, std::int64_t number, const std::string& reason,
                             const std::vector<std::string>& looms, std::string password) {
    Json body{{"reason", reason}, {"password", password}};
    wipe(password);
    if (!looms.empty()) body["looms"] = looms;
    return client.post(revision_path(design, number) + "/submit", std::move(body));
}

Result<Json> comment_on(MillClient& client, const std::string& design, std::int64_t number, const std::string& text,
                        std::optional<std::int64_t> pick, std::optional<std::int64_t> end) {
    Json body{{"text", text}};
    if (pick) body["pick"] = *pick;
    if (end) body["end"] = *end;
    return client.post(revision_path(design, number) + "/comment", std::move(body));
}

}  // namespace weave::wire
