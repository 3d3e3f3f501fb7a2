#include <loomlink/commands/site_folder.hpp>

#include <weave/keys/private_file.hpp>
#include <weave/keys/server_key.hpp>

#include <cerrno>
#include <cstring>
#include <loomlink/workflow/retelling.hpp>
#include <sys/stat.h>
#include <utility>

namespace weave::loomlink {

namespace fs = std::filesystem;

namespace {

constexpr const char* lock_name = ".lock";

Error fault(const fs::path& path, const std::string& action) {
    return system_fault("cannot " + action + ": " + std::strerror(errno), path.string());
}

/// Whether a folder holds nothing but, perhaps, our lock.
Result<bool> holds_nothing(const fs::path& folder) {
    std::error_code trouble;
    fs::directory_iterator entries(folder, trouble);
    if (trouble) return system_fault("cannot be read: " + trouble.message(), folder.string());
    for (const auto& entry : entries)
        if (entry.path().filename() != lock_name) return false;
    return true;
}

Result<OpenSite> make_site(FolderLock lock, const SiteFolder& folder, const std::string& name) {
    WEAVE_TRY(KeyPair log, create_server_key(folder.log_key(), ServerKeyRole::log));
    WEAVE_TRY(KeyPair stamp, create_server_key(folder.stamp_key(), ServerKeyRole::stamp));
    WEAVE_TRY(KeyPair access, create_server_key(folder.access_key(), ServerKeyRole::access));
    WEAVE_TRY(Store store, Store::create(folder.store(), name));
    return OpenSite{std::move(lock), std::move(store), {std::move(log), std::move(stamp), std::move(access)}, name, true};
}

/// The key for access tokens. Sites that were made before there was one have none yet.
Result<KeyPair> access_key_of(const SiteFolder& folder) {
    std::error_code trouble;
    if (fs::exists(fs::symlink_status(folder.access_key(), trouble)))
        return load_server_key(folder.access_key(), ServerKeyRole::access);
    return create_server_key(folder.access_key(), ServerKeyRole::access);
}

/// Nothing is served that somebody changed past the program: a recall that was undone would go to a loom.
Status check_tables(const SiteFolder& folder) {
    WEAVE_TRY(const auto findings, verify_tables(folder.store()));
    if (findings.empty()) return {};
    return Error{ErrorCode::refused,
                 "was changed by something else than loomlink: " + findings.front().text() +
                     "; `loomlink verify` tells all, a backup can be restored",
                 folder.store().string()};
}

Result<OpenSite> open_old_site(FolderLock lock, const SiteFolder& folder) {
    WEAVE_TRY(KeyPair log, load_server_key(folder.log_key(), ServerKeyRole::log));
    WEAVE_TRY(KeyPair stamp, load_server_key(folder.stamp_key(), ServerKeyRole::stamp));
    WEAVE_TRY(KeyPair access, access_key_of(folder));
    WEAVE_TRY(Store store, Store::open(folder.store()));
    WEAVE_CHECK_OK(check_tables(folder));
    WEAVE_TRY(std::string name, store.read([](const Reader& reader) { return reader.site(); }));
    return OpenSite{std::move(lock), std::move(store), {std::move(log), std::move(stamp), std::move(access)}, std::move(name), false};
}

}  // namespace

std::string SiteFolder::whole_path() const {
    std::error_code unknown;
    return fs::absolute(path, unknown).lexically_normal().string();
}

Status check_site_folder(const SiteFolder& folder) {
    std::error_code trouble;
    if (fs::exists(folder.store(), trouble)) return {};
    WEAVE_TRY(const bool empty, holds_nothing(folder.path));
    if (empty) return {};
    return Error{ErrorCode::refused, "holds no store of loomlink, and is not empty", folder.path.string()};
}

Result<OpenSite> open_site(const SiteFolder& folder, const ServeConfig& config) {
    WEAVE_CHECK_OK(make_service_folder(folder.path));
    WEAVE_CHECK_OK(check_site_folder(folder));
    std::error_code trouble;
    WEAVE_TRY(FolderLock lock, FolderLock::take(folder.path, "loomlink"));
    if (fs::exists(folder.store(), trouble)) return open_old_site(std::move(lock), folder);
    if (::chmod(folder.path.c_str(), 0700) != 0) return fault(folder.path, "close it to others");
    return make_site(std::move(lock), folder, config.site);
}

}  // namespace weave::loomlink
