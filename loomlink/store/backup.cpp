#include <loomlink/store/backup.hpp>

#include <weave/sql/sqlite.hpp>

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <loomlink/store/copy.hpp>
#include <loomlink/store/server.hpp>
#include <loomlink/store/store.hpp>
#include <unistd.h>

namespace weave::loomlink {

namespace fs = std::filesystem;

void remove_database(const fs::path& path) {
    std::error_code ignored;
    for (const char* suffix : {"", "-wal", "-shm", "-journal"}) fs::remove(path.string() + suffix, ignored);
}

namespace {

constexpr int pages_a_step = 1024;
constexpr int pause_ms = 50;
constexpr int most_pauses = 200;  // ten seconds of a store that is busy all the time

fs::path beside(const fs::path& to) {
    fs::path temporary = to;
    return temporary += ".part-" + std::to_string(::getpid());
}

/// Removes a half-made copy unless it was put into place.
struct Temporary {
    fs::path path;
    ~Temporary() { remove_database(path); }
};

Status flush(const fs::path& path, int flags) {
    const int file = ::open(path.c_str(), flags | O_CLOEXEC);
    const bool flushed = file >= 0 && ::fsync(file) == 0;
    if (file >= 0) ::close(file);
    if (!flushed) return system_fault("cannot be flushed to the disk", path.string());
    return {};
}

fs::path folder_of(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

Status copy_pages(sql::SqliteConnection& source, sql::SqliteConnection& target) {
    sqlite3_backup* backup = sqlite3_backup_init(target.handle(), "main", source.handle(), "main");
    if (backup == nullptr) return target.trouble(sqlite3_errcode(target.handle()));
    int code = SQLITE_OK;
    for (int pauses = 0; code == SQLITE_OK || ((code & 0xff) == SQLITE_BUSY && pauses < most_pauses);) {
        code = sqlite3_backup_step(backup, pages_a_step);
        if ((code & 0xff) != SQLITE_BUSY) continue;
        sqlite3_sleep(pause_ms);
        ++pauses;
    }
    const int finished = sqlite3_backup_finish(backup);
    if (code != SQLITE_DONE) return target.trouble(finished == SQLITE_OK ? code : finished);
    return {};
}

/// An empty file for its owner alone, since a store holds password hashes and sealed keys.
Status make_empty(const fs::path& path) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (file < 0) return system_fault(std::string("cannot be made: ") + std::strerror(errno), path.string());
    ::close(file);
    return {};
}

/// A copy as one closed file, flushed.
Status make_copy(const std::string& from, const std::string& to) {
    WEAVE_TRY(auto source, sql::SqliteConnection::open_file(from, sql::Access::read));
    WEAVE_TRY(auto target, sql::SqliteConnection::open_file(to, sql::Access::create));
    // One view for all pages, so that writes meanwhile neither show nor start the copy anew.
    WEAVE_CHECK_OK(source->script("BEGIN; SELECT count(*) FROM sqlite_schema"));
    return copy_pages(*source, *target);
}

struct Closed {
    void operator()(sqlite3* file) const { sqlite3_close(file); }
};
using File = std::unique_ptr<sqlite3, Closed>;

/// Closes the way to a store for all others for as long as the answer lives; refused while anybody has it open. What is so damaged
/// that nobody can open it needs no closing.
Result<File> shut(const fs::path& path) {
    sqlite3* opened = nullptr;
    int code = sqlite3_open_v2(path.c_str(), &opened, SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_READWRITE, nullptr);
    File file(opened);
    // Only the last connection may leave WAL, and the other journal takes no second one beside an exclusive
    // lock.
    for (const char* script : {"PRAGMA journal_mode = DELETE", "BEGIN EXCLUSIVE"})
        if (code == SQLITE_OK) code = sqlite3_exec(opened, script, nullptr, nullptr, nullptr);
    if (code == SQLITE_BUSY || code == SQLITE_LOCKED)
        return Error{ErrorCode::refused, "is in use; stop the program that has it open", path.string()};
    return file;
}

/// A second name for the file of a store, and its WAL, which a damaged one may still have, under that name alone.
Status keep_as(const fs::path& file, const fs::path& aside) {
    std::error_code code, ignored;
    fs::create_hard_link(file, aside, code);
    if (code) return system_fault("cannot be kept as " + aside.string() + ": " + code.message(), file.string());
    const fs::path wal = file.string() + "-wal";
    if (fs::exists(wal, ignored)) fs::rename(wal, aside.string() + "-wal", code);
    if (code) return system_fault("cannot be set aside: " + code.message(), wal.string());
    fs::remove(file.string() + "-shm", ignored);
    return {};
}

/// Replaces the file of a store that no program has open, and keeps what was there.
Status put_into_place(const fs::path& backup, const fs::path& to, const fs::path& aside) {
    File held;
    std::error_code code;
    const Temporary temporary{beside(to)};
    WEAVE_CHECK_OK(make_empty(temporary.path));
    WEAVE_CHECK_OK(make_copy(backup.string(), temporary.path.string()));
    WEAVE_CHECK_OK(flush(temporary.path, O_RDWR));
    if (fs::exists(to, code)) {
        WEAVE_TRY(held, shut(to));
        WEAVE_CHECK_OK(keep_as(to, aside));
    }
    fs::rename(temporary.path, to, code);
    if (code) return system_fault("cannot be put into place: " + code.message(), to.string());
    return flush(folder_of(to), O_RDONLY | O_DIRECTORY);
}

/// A database keeps one store: the one that was there becomes a file. It goes again where nothing was replaced for certain.
Status replace_in_database(const fs::path& backup, const std::string& database, const fs::path& aside) {
    WEAVE_CHECK_OK(refuse_in_use(database));
    WEAVE_TRY(const bool is_there, holds_store(database));
    if (is_there) WEAVE_CHECK_OK(copy_store(database, aside.string()));
    Status replaced = replace_store(backup, database);
    if (is_there && !replaced && replaced.error().code != ErrorCode::system) remove_database(aside);
    return replaced;
}

}  // namespace

Status make_database(const fs::path& to, const std::function<Status(const std::string&)>& fill) {
    std::error_code code;
    if (fs::exists(to, code)) return Error{ErrorCode::refused, "exists already", to.string()};
    const Temporary temporary{beside(to)};
    WEAVE_CHECK_OK(make_empty(temporary.path));
    WEAVE_CHECK_OK(fill(temporary.path.string()));
    WEAVE_CHECK_OK(flush(temporary.path, O_RDWR));
    fs::create_hard_link(temporary.path, to, code);  // unlike a rename, it replaces nothing
    if (code) return system_fault("cannot be put into place: " + code.message(), to.string());
    return flush(folder_of(to), O_RDONLY | O_DIRECTORY);
}

Status copy_database(const std::string& from, const fs::path& to) {
    return make_database(to, [&](const std::string& temporary) { return make_copy(from, temporary); });
}

Result<bool> holds_store(const std::string& place) {
    std::error_code code;
    if (!is_database(place)) return fs::exists(place, code);
    WEAVE_TRY(const auto connection, sql::Connection::open(place, sql::Access::read));
    WEAVE_TRY(const bool is_empty, connection->is_empty());
    return !is_empty;
}

Status restore_store(const fs::path& backup, const std::string& to, const fs::path& aside) {
    WEAVE_TRY(const auto findings, verify_store(backup));
    if (!findings.empty())
        return Error{ErrorCode::refused, "is not whole: " + findings.front().text(), backup.string()};
    return is_database(to) ? replace_in_database(backup, to, aside) : put_into_place(backup, to, aside);
}

}  // namespace weave::loomlink
