#include <loomlink/commands/site_restore.hpp>

#include <weave/core/file.hpp>
#include <weave/core/text.hpp>

#include <algorithm>
#include <loomlink/commands/site_copy.hpp>
#include <loomlink/store/server.hpp>
#include <sys/stat.h>

namespace weave::loomlink {

namespace fs = std::filesystem;

namespace {

fs::path aside_of(const fs::path& file) {
    return file.string() + ".replaced";
}

/// What stands in the way of a backup: how the log there differs from the backup's.
struct LogThere {
    std::uint64_t size = 0, shared = 0;  ///< records, and how many of them are the backup's first ones
    std::optional<EventRecord> newest;
    std::string damage;  ///< why the log cannot be read; else empty
    [[nodiscard]] bool is_of_another_site() const { return size > 0 && shared == 0 && damage.empty(); }
    [[nodiscard]] bool goes_on() const { return size > shared || !damage.empty(); }
};

/// With how many records both logs begin.
Result<std::uint64_t> shared_records(const Reader& one, const Reader& other) {
    WEAVE_TRY(const std::uint64_t size, one.log_size());
    WEAVE_TRY(std::uint64_t above, other.log_size());
    std::uint64_t shared = 0;
    for (above = std::min(above, size); shared < above;) {
        const std::uint64_t middle = shared + (above - shared + 1) / 2;
        WEAVE_TRY(const Hash root, one.root(middle));
        WEAVE_TRY(const Hash other_root, other.root(middle));
        (root == other_root ? shared : above) = root == other_root ? middle : middle - 1;
    }
    return shared;
}

Result<LogThere> read_log(const std::string& backup, const std::string& store) {
    LogThere there;
    const auto compare = [&](const Reader& kept, const Reader& reader) -> Status {
        WEAVE_TRY(there.size, reader.log_size());
        WEAVE_TRY(there.shared, shared_records(kept, reader));
        if (there.size == 0) return {};
        WEAVE_TRY(there.newest, reader.record(there.size - 1));
        return {};
    };
    const Status read = look_into(backup, [&](const Reader& kept) {
        return look_into(store, [&](const Reader& reader) { return compare(kept, reader); });
    });
    if (read) return there;
    if (is_database(store)) return read.error();  // out of reach, or another program's
    there.damage = read.error().text();
    return there;
}

std::string words_of(const LogThere& there) {
    if (!there.damage.empty()) return "its log cannot be read (" + there.damage + "), so that nobody can say what would be lost";
    const Statement& newest = there.newest->statement;
    const std::string last = "the newest of " + newest.at + ": " + newest.kind + ", by " + newest.actor;
    if (there.is_of_another_site()) return "holds another site than the backup, with " + counted(there.size, "record") + ", " + last;
    return "its log has " + counted(there.size - there.shared, "record") + " that the backup has not, " + last;
}

/// Told before anything is done.
Status check_names_are_free(const SiteFolder& site, const LogThere& there) {
    std::vector<fs::path> files{site.own_store()};
    if (there.is_of_another_site())
        for (const fs::path& key : site.key_files()) files.push_back(key);
    std::error_code trouble;
    for (const fs::path& file : files)
        if (fs::exists(fs::symlink_status(aside_of(file), trouble)))
            return Error{ErrorCode::refused, "is in the way: put it elsewhere, it is of an earlier restore", aside_of(file).string()};
    return {};
}

Status check_may_go(const SiteFolder& site, const LogThere& there, bool may_replace) {
    WEAVE_CHECK_OK(check_names_are_free(site, there));
    if (may_replace || !there.goes_on()) return {};
    return Error{ErrorCode::refused,
                 words_of(there) + ". --replace puts the backup in its place all the same, and keeps what is there as " +
                     aside_of(site.own_store()).string(),
                 site.path.string()};
}

/// They sign for their own log alone.
Status set_keys_aside(const SiteFolder& site) {
    std::error_code trouble;
    for (const fs::path& key : site.key_files()) {
        if (!fs::exists(fs::symlink_status(key, trouble))) continue;
        fs::rename(key, aside_of(key), trouble);
        if (trouble) return system_fault("cannot be set aside: " + trouble.message(), key.string());
    }
    return {};
}

Status check_backup(const SiteFolder& backup) {
    WEAVE_TRY(const auto findings, verify_site(backup, {}));
    if (findings.empty()) return {};
    return Error{ErrorCode::refused, "is not as it was written: " + findings.front().text() + " (verify tells all)",
                 backup.path.string()};
}

}  // namespace

Result<std::optional<fs::path>> restore_site(const SiteFolder& backup, const SiteFolder& to, bool may_replace) {
    WEAVE_CHECK_OK(check_backup(backup));
    std::error_code code;
    if (!fs::exists(to.path, code) && ::mkdir(to.path.c_str(), 0700) != 0) return file_fault(to.path, "make the folder");
    WEAVE_CHECK_OK(check_site_folder(to));
    WEAVE_TRY(const FolderLock lock, FolderLock::take(to.path, "loomlink"));
    WEAVE_TRY(const std::string store, to.store());
    WEAVE_TRY(const bool is_there, holds_store(store));
    LogThere there;
    if (is_there) {
        WEAVE_TRY(there, read_log(backup.own_store().string(), store));
        WEAVE_CHECK_OK(check_may_go(to, there, may_replace));
    }
    const fs::path aside = aside_of(to.own_store());
    WEAVE_CHECK_OK(restore_store(backup.own_store(), store, aside));
    if (there.is_of_another_site()) WEAVE_CHECK_OK(set_keys_aside(to));
    WEAVE_CHECK_OK(copy_keys(backup, to));
    return is_there ? std::optional(aside) : std::nullopt;
}

}  // namespace weave::loomlink
