#pragma once

#include <weave/core/result.hpp>

#include <filesystem>
#include <functional>
#include <loomlink/audit/bundle.hpp>
#include <loomlink/store/reader.hpp>
#include <loomlink/store/writer.hpp>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace weave::loomlink {

/// The one way to what loomlink keeps, in the place that sql::engine_of() tells: one file of SQLite, or a database of
/// PostgreSQL, which several programs may have open. Any thread may call. What a write() has answered well survives kill -9
/// and power loss, and on a server with a synchronous standby the loss of the primary.
class Store {
  public:
    /// Makes a store for a site. Refused where the file exists, or the database holds one.
    static Result<Store> create(const std::string& place, const std::string& site);
    /// Opens a store, and brings one of an older version up to date. Refused: a newer one, another program's
    /// file, and as of open_writer(). `standby`: the place of a server that follows, from which views are then read as
    /// long as it shows all that the primary has; else from the primary.
    static Result<Store> open(const std::string& place, const std::string& standby = {});
    /// Waits for the writes under way.
    ~Store();
    Store(Store&&) noexcept;
    Store& operator=(Store&&) noexcept;

    /// Runs `change` in the one writer thread and answers once it is on the disk: all of it, or nothing where
    /// `change` or the disk fails, and where the server is away (lost_of()). Changes that wait together share one commit. `change`
    /// must not call the store itself.
    Status commit(const std::function<Status(Writer&)>& change);
    /// The same with an answer: `change` gives a Status or a Result.
    template <class Change>
    std::invoke_result_t<Change, Writer&> write(Change change) {
        return answer_of<std::invoke_result_t<Change, Writer&>, Writer>(
            change, [this](const std::function<Status(Writer&)>& run) { return commit(run); });
    }

    /// Runs `ask` on one unchanging view of the store, beside writes and other readers.
    Status view(const std::function<Status(const Reader&)>& ask) const;
    template <class Ask>
    std::invoke_result_t<Ask, const Reader&> read(Ask ask) const {
        return answer_of<std::invoke_result_t<Ask, const Reader&>, const Reader>(
            ask, [this](const std::function<Status(const Reader&)>& run) { return view(run); });
    }

    /// How the disk took the last write: an error of the system while it is full or fails.
    [[nodiscard]] Status last_write() const;

  private:
    class Core;
    explicit Store(std::unique_ptr<Core> core);

    template <class Answer, class Access, class Call, class Run>
    static Answer answer_of(Call& call, Run run) {
        if constexpr (std::is_same_v<Answer, Status>) {
            return run(call);
        } else {
            std::optional<Answer> answer;
            WEAVE_CHECK_OK(run([&](Access& access) -> Status {
                answer.emplace(call(access));
                if (*answer) return {};
                return answer->error();
            }));
            return *std::move(answer);
        }
    }

    std::unique_ptr<Core> m_core;
};

/// Whether Store::open() would take a place, or Store::create() one on a server where it `is_new`. Changes nothing.
Status check_store(const std::string& place, bool is_new);

/// Asks a store on one unchanging view; changes nothing, also while it is in use.
Status look_into(const std::string& place, const std::function<Status(const Reader&)>& ask);

/// Copies a store, in use or not, into a new file of SQLite. Refused where it exists.
Status back_up_store(const std::string& place, const std::filesystem::path& to);

/// Whether there is a file, or anything in a database.
Result<bool> holds_store(const std::string& place);

/// Puts a backup into place, whole or not at all, after verifying it. The store that was there stays as the file `aside`,
/// which must not exist. Refused: a backup with findings, and a target that a program has open.
Status restore_store(const std::filesystem::path& backup, const std::string& to, const std::filesystem::path& aside);

/// What verify_store() trusts beforehand. What is missing is not checked.
struct StoreTrust {
    SignatureCheck log;
    SignatureCheck statements;
    std::optional<SignedTreeHead> retained;
};

/// Everything that a store holds, looked at once more: pages and links by the database, every object's hash, every
/// record, its leaf and chain, the tree, the heads, every revision's hash. Whether the tables say what the log tells
/// is for those who know what each record means (workflow/retelling.hpp).
/// Empty: all well. An error only where the store cannot be read at all.
Result<std::vector<AuditFinding>> verify_store(const std::string& place,
                                               const StoreTrust& trust = {});

}  // namespace weave::loomlink
