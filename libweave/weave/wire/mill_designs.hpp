#pragma once

#include <weave/wire/evidence.hpp>
#include <weave/wire/mill_client.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

// Designs and their revisions at a loomlink, as its API (loomlink/service/API.md) tells them. Times are UTC, ISO 8601. Errors of all
// calls are MillClient's; bad_input besides where an answer lacks what it must have. Members that an older server does not tell are
// empty.

namespace weave::wire {

/// No document of a design has more bytes.
inline constexpr std::size_t most_design_bytes = std::size_t{32} << 20;
/// The branch that a design has if nobody says otherwise.
inline constexpr const char* main_branch = "main";

/// The person of a session.
struct MillPerson {
    std::string name, full_name;
    std::vector<std::string> roles;  ///< `designer`, `approver`, …
};
Result<MillPerson> who_am_i(MillClient& client);

/// A line of the list of designs.
struct MillDesign {
    std::string name;
    std::optional<std::int64_t> newest;  ///< its newest revision; nothing where it has none
    std::string state;                   ///< of that revision
};
Result<std::vector<MillDesign>> list_designs(MillClient& client);
Status make_design(MillClient& client, const std::string& name);

struct MillBranch {
    std::string name;
    std::int64_t head = 0;
    friend bool operator==(const MillBranch&, const MillBranch&) = default;
};

/// A revision as the history of its design tells it.
struct MillRevision {
    std::int64_t number = 0;
    std::string state;  ///< `draft`, `submitted`, `changes_requested`, `approved`, `released`, `superseded`, `withdrawn`
    std::string author, at, message;
    friend bool operator==(const MillRevision&, const MillRevision&) = default;
};

/// A release of some revision to a loom.
struct MillRelease {
    std::string loom, state;
    std::int64_t number = 0, revision = 0;
    friend bool operator==(const MillRelease&, const MillRelease&) = default;
};

struct MillHistory {
    std::string design;
    std::vector<MillBranch> branches;
    std::vector<MillRevision> revisions;  ///< newest first
    std::vector<MillRelease> releases;

    /// Where a branch stands, or main, where a new one starts; nothing in a design without revisions.
    [[nodiscard]] std::optional<std::int64_t> head_of(const std::string& branch) const;
    friend bool operator==(const MillHistory&, const MillHistory&) = default;
};
Result<MillHistory> history_of(MillClient& client, const std::string& design);

struct MillDecision {
    std::string what, by, at, reason;  ///< what: `submitted`, `approved` or `changes requested`
    friend bool operator==(const MillDecision&, const MillDecision&) = default;
};
struct MillComment {
    std::string by, at, text;
    std::optional<std::int64_t> pick, end;  ///< the place that it is about, from 1
    friend bool operator==(const MillComment&, const MillComment&) = default;
};
struct MillEvidence {
    std::string kind;  ///< `validation` or `simulation`
    std::string covers, result, signer, at;
    std::string stale;  ///< why it does not count; empty where it does
    friend bool operator==(const MillEvidence&, const MillEvidence&) = default;
};

/// All that is known of one revision.
struct MillReview {
    std::string design;
    MillRevision revision;  ///< its author by full name
    std::int64_t picks = 0, ends = 0;
    std::string design_sha256, scene_sha256, document_sha256;
    std::vector<std::string> missing;  ///< for approval and release, in words
    std::vector<std::string> may;      ///< what this person may do with it now: `submit`, `comment`, …
    std::optional<MillDecision> submission;  ///< none of a draft
    std::vector<MillDecision> decisions;
    std::vector<MillComment> comments;
    std::vector<MillEvidence> evidence;

    [[nodiscard]] bool allows(const std::string& action) const;
    friend bool operator==(const MillReview&, const MillReview&) = default;
};
Result<MillReview> review_of(MillClient& client, const std::string& design, std::int64_t number);

/// `/designs/shoe/revisions/3`
std::string revision_path(const std::string& design, std::int64_t number);

/// The .weave file of a revision.
Result<std::string> document_of(MillClient& client, const std::string& design, std::int64_t number);

/// What is saved as the next revision of a design.
struct RevisionToSave {
    std::string document;  ///< text of a .weave file
    std::string branch = main_branch;
    std::optional<std::int64_t> expected;  ///< the head of the branch that it was made from; nothing in a design without revisions
    std::string message;                   ///< what changed
    std::vector<std::int64_t> also{};      ///< other parents, of a merge
};
/// Gives the server's answer: `number`, `sha256`. Errors (refused): the branch moved on, or holds this very document.
Result<Json> save_revision(MillClient& client, const std::string& design, RevisionToSave wish);

/// Files what a machine signed for a revision, and gives its number. The server judges the signature, and for whom it was given.
Result<Json> file_evidence(MillClient& client, const std::string& design, std::int64_t number, const SignedEvidence& evidence);

/// Submits a revision for approval, signed with the person's password. Meant for all looms where none is named. The answer: `state`.
Result<Json> submit_revision(MillClient& client, const std::string& design, std::int64_t number, const std::string& reason,
                             const std::vector<std::string>& looms, std::string password);

/// Says something about a revision, or about a place of its card.
Result<Json> comment_on(MillClient& client, const std::string& design, std::int64_t number, const std::string& text,
                        std::optional<std::int64_t> pick = {}, std::optional<std::int64_t> end = {});

}  // namespace weave::wire
