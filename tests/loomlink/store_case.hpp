#pragma once

#include "audit_case.hpp"

#include "store_places.hpp"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <loomlink/store/store.hpp>
#include <stdexcept>
#include <string>

namespace weave::loomlink::testing {

inline std::string all_text(const std::vector<AuditFinding>& findings) {
    std::string text;
    for (const AuditFinding& finding : findings) text += finding.text() + "\n";
    return text;
}

inline bool has_words(const std::vector<AuditFinding>& findings, const std::string& words) {
    return std::any_of(findings.begin(), findings.end(), [&](const AuditFinding& finding) {
        return finding.text().find(words) != std::string::npos;
    });
}

inline std::string text_of(const Status& status) {
    return status ? "" : status.error().text();
}
template <class T>
std::string text_of(const Result<T>& result) {
    return result ? "" : result.error().text();
}

/// An event that says nothing much.
inline Result<Seq> note(Writer& writer, std::uint64_t number = 1) {
    return writer.append(statement_of(number));
}

/// A small mill: three people, one design, one loom with a profile.
struct Mill {
    Folder folder;
    std::string path = folder.store("store.db");
    Store store = Store::create(path, "mill").value();
    Id anna = 0, bert = 0, cleo = 0, shoe = 0, loom = 0;

    Mill() {
        const Status status = store.write([&](Writer& writer) -> Status {
            WEAVE_TRY(const Seq event, note(writer));
            WEAVE_TRY(anna,
                      writer.add_person({0, "anna", "Anna A", true, "hash", {PersonRole::designer}, event}));
            WEAVE_TRY(bert,
                      writer.add_person({0, "bert", "Bert B", true, "hash", {PersonRole::approver}, event}));
            WEAVE_TRY(cleo,
                      writer.add_person({0, "cleo", "Cleo C", true, "hash", {PersonRole::operator_}, event}));
            WEAVE_TRY(shoe, writer.add_design("shoe", event));
            WEAVE_TRY(loom, writer.add_loom("EP 1", event));
            WEAVE_TRY(const Hash profile, writer.put_object("profile"));
            WEAVE_CHECK_OK(writer.add_profile(loom, profile, event));
            return writer.add_key({key_id(), bert, "release", Hash{1}, "sealed", event, {}});
        });
        if (!status) throw std::runtime_error(status.error().text());
    }

    static std::string key_id() { return std::string(64, 'a'); }

    /// A draft of `author` on these parents.
    [[nodiscard]] Result<Revision> draft(Writer& writer, Id author,
                                         const std::vector<Id>& parents = {}) const {
        static std::atomic<int> count = 0;
        const std::string name = "document " + std::to_string(count++);
        WEAVE_TRY(const Seq event, note(writer));
        Revision revision;
        revision.design = shoe;
        revision.author = author;
        revision.parents = parents;
        revision.at = "2026-11-26T09:30:00.000Z";
        revision.message = name;
        WEAVE_TRY(revision.document, writer.put_object(name));
        revision.design_sha256 = sha256("design " + name);
        revision.scene_sha256 = sha256("scene");
        revision.card_sha256 = sha256("card");
        revision.picks = 8;
        revision.ends = 5;
        revision.event = event;
        return writer.add_revision(revision);
    }
    static Status go(Writer& writer, Id revision, RevisionState state) {
        WEAVE_TRY(const Seq event, note(writer));
        return writer.set_state(revision, state, event);
    }
    static Status decide(Writer& writer, Id revision, Id person, DecisionKind kind = DecisionKind::approve) {
        WEAVE_TRY(const Seq event, note(writer));
        return writer.add_decision({revision, person, kind, event});
    }
    /// A draft of anna's that bert approved.
    [[nodiscard]] Result<Revision> approved(Writer& writer, const std::vector<Id>& parents = {}) const {
        WEAVE_TRY(const Revision revision, draft(writer, anna, parents));
        WEAVE_CHECK_OK(go(writer, revision.id, RevisionState::submitted));
        WEAVE_CHECK_OK(decide(writer, revision.id, bert));
        WEAVE_CHECK_OK(go(writer, revision.id, RevisionState::approved));
        WEAVE_TRY(auto now, writer.revision(revision.id));
        return *std::move(now);
    }
};

}  // namespace weave::loomlink::testing
