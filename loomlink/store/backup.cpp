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

namespace {

namespace fs = std::filesystem;

constexpr int pages_a_step = 1024;
constexpr int pause_ms = 50;
constexpr int most_pauses = 200;  // ten seconds of a store that is busy all the time

fs::path beside(const fs::path& to) {
    fs::path temporary = to;
    return temporary += ".part-" + std::to_string(::getpid());
}

void remove_database(const fs::path& path) {
    std::error_code ignored;
    for (const char* suffix : {"", "-wal", "-shm", "-journal"}) fs::remove(path.string() + suffix, ignored);
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

/// Closes the way to a store for all others for as long as the connection lives; refused while anybody has it
/// open.
Result<std::unique_ptr<sql::SqliteConnection>> shut(const fs::path& path) {
    WEAVE_TRY(auto connection, sql::SqliteConnection::open_file(path.string(), sql::Access::write));
    sqlite3_busy_timeout(connection->handle(), 0);
    // Only the last connection may leave WAL, and the other journal takes no second one beside an exclusive
    // lock.
    if (!connection->script("PRAGMA journal_mode = DELETE") || !connection->script("BEGIN EXCLUSIVE"))
        return Error{ErrorCode::refused, "is in use; stop the program that has it open", path.string()};
    return connection;
}

/// Replaces the file of a store that no program has open.
Status put_into_place(const fs::path& backup, const fs::path& to) {
    std::unique_ptr<sql::SqliteConnection> held;
    std::error_code code;
    const Temporary temporary{beside(to)};
    WEAVE_CHECK_OK(make_empty(temporary.path));
    WEAVE_CHECK_OK(make_copy(backup.string(), temporary.path.string()));
    WEAVE_CHECK_OK(flush(temporary.path, O_RDWR));
    if (fs::exists(to, code)) {
        WEAVE_TRY(held, shut(to));
    }
    fs::rename(temporary.path, to, code);
    if (code) return system_fault("cannot be put into place: " + code.message(), to.string());
    return flush(folder_of(to), O_RDONLY | O_DIRECTORY);
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

Status restore_store(const fs::path& backup, const std::string& to) {
    WEAVE_TRY(const auto findings, verify_store(backup));
    if (!findings.empty())
        return Error{ErrorCode::refused, "is not whole: " + findings.front().text(), backup.string()};
    if (is_database(to)) return replace_store(backup, to);
    return put_into_place(backup, to);
}

}  // namespace weave::loomlink
