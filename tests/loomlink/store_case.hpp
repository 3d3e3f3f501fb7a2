#pragma once

#include "audit_case.hpp"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <loomlink/store/store.hpp>
#include <sqlite3.h>
#include <stdexcept>
#include <string>
#include <unistd.h>

namespace weave::loomlink::testing {

/// A folder of its own, removed at the end.
class Folder {
  public:
    Folder() {
        static std::atomic<int> count = 0;
        m_path = std::filesystem::temp_directory_path() /
                 ("weave-store-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
        std::filesystem::remove_all(m_path);
        std::filesystem::create_directories(m_path);
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(m_path, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return m_path / name; }

  private:
    std::filesystem::path m_path;
};

/// flip(blob, number): the blob with one bit turned, whichever the number comes to.
inline void flip_bit(sqlite3_context* context, int, sqlite3_value** values) {
    const auto* data = static_cast<const char*>(sqlite3_value_blob(values[0]));
    std::string bytes(data, static_cast<std::size_t>(sqlite3_value_bytes(values[0])));
    const auto bit = static_cast<std::size_t>(sqlite3_value_int64(values[1])) % (8 * bytes.size());
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
    sqlite3_result_blob(context, bytes.data(), static_cast<int>(bytes.size()), SQLITE_TRANSIENT);
}

/// Runs SQL on a store's file behind its back, rules or no rules.
inline void tamper_with(const std::filesystem::path& path, const std::string& sql) {
    sqlite3* handle = nullptr;
    if (sqlite3_open(path.c_str(), &handle) != SQLITE_OK) throw std::runtime_error("cannot open");
    sqlite3_create_function(handle, "flip", 2, SQLITE_UTF8, nullptr, flip_bit, nullptr, nullptr);
    char* message = nullptr;
    const int code = sqlite3_exec(handle, sql.c_str(), nullptr, nullptr, &message);
    const std::string text = message == nullptr ? "" : message;
    sqlite3_free(message);
    sqlite3_close(handle);
    if (code != SQLITE_OK) throw std::runtime_error(text);
}

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
    std::filesystem::path path = folder / "store.db";
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
