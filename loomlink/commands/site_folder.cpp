#include <loomlink/commands/site_folder.hpp>

#include <weave/core/file.hpp>
#include <weave/keys/private_file.hpp>
#include <weave/keys/server_key.hpp>
#include <weave/net/server.hpp>

#include <cerrno>
#include <cstring>
#include <loomlink/store/server.hpp>
#include <loomlink/workflow/retelling.hpp>
#include <sys/stat.h>
#include <utility>

namespace weave::loomlink {

namespace fs = std::filesystem;

namespace {

constexpr const char* lock_name = ".lock";
constexpr std::uint64_t most_place = 4096;

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

/// Takes a folder away that was made for a site which then could not be; the lock in it is ours still.
void leave_nothing(const fs::path& folder) {
    const auto empty = holds_nothing(folder);
    if (!empty || !*empty) return;
    std::error_code trouble;
    fs::remove(folder / lock_name, trouble);
    fs::remove(folder, trouble);
}

/// The keys, and the store: last what makes the folder a site, so that one is never half there. A database comes first, since
/// it may be out of reach.
Result<OpenSite> make_site(FolderLock lock, const SiteFolder& folder, const ServeConfig& config, bool was_there) {
    std::optional<Store> made;
    if (!config.store.empty()) {
        Result<Store> created = Store::create(config.store, config.site);
        if (!created && !was_there) leave_nothing(folder.path);
        WEAVE_TRY(made, std::move(created));
    }
    WEAVE_TRY(KeyPair log, create_server_key(folder.log_key(), ServerKeyRole::log));
    WEAVE_TRY(KeyPair stamp, create_server_key(folder.stamp_key(), ServerKeyRole::stamp));
    WEAVE_TRY(KeyPair access, create_server_key(folder.access_key(), ServerKeyRole::access));
    if (made) {
        WEAVE_CHECK_OK(create_private_file(folder.store_place(), config.store + "\n"));
    } else {
        WEAVE_TRY(made, Store::create(folder.own_store(), config.site));
    }
    return OpenSite{std::move(lock), *std::move(made), {std::move(log), std::move(stamp), std::move(access)}, config.site, true};
}

/// The key for access tokens. Sites that were made before there was one have none yet.
Result<KeyPair> access_key_of(const SiteFolder& folder) {
    std::error_code trouble;
    if (fs::exists(fs::symlink_status(folder.access_key(), trouble)))
        return load_server_key(folder.access_key(), ServerKeyRole::access);
    return create_server_key(folder.access_key(), ServerKeyRole::access);
}

/// Nothing is served that somebody changed past the program: a recall that was undone would go to a loom.
Status check_tables(const std::string& store) {
    WEAVE_TRY(const auto findings, verify_tables(store));
    if (findings.empty()) return {};
    return Error{ErrorCode::refused,
                 "was changed by something else than loomlink: " + findings.front().text() +
                     "; `loomlink verify` tells all, a backup can be restored",
                 store};
}

/// Where the store of a site is. Refused: elsewhere than the configuration says.
Result<std::string> place_of_store(const SiteFolder& folder, const ServeConfig& config) {
    WEAVE_TRY(const std::string place, folder.store());
    if (config.store.empty() || config.store == place) return place;
    return Error{ErrorCode::refused, "the store of this site is " + place + "; `loomlink migrate-store` moves it", "store"};
}

Status check_keys(const SiteFolder& folder, const ServeConfig& config) {
    WEAVE_CHECK_OK(load_server_key(folder.log_key(), ServerKeyRole::log));
    WEAVE_CHECK_OK(load_server_key(folder.stamp_key(), ServerKeyRole::stamp));
    std::error_code trouble;
    if (fs::exists(fs::symlink_status(folder.access_key(), trouble)))
        WEAVE_CHECK_OK(load_server_key(folder.access_key(), ServerKeyRole::access));
    const bool is_own = !config.plain && config.certificate.empty() && fs::exists(folder.tls().certificate, trouble);
    return is_own ? net::check_tls(folder.tls()) : Status();
}

Result<OpenSite> open_old_site(FolderLock lock, const SiteFolder& folder, const ServeConfig& config) {
    WEAVE_TRY(const std::string place, place_of_store(folder, config));
    WEAVE_TRY(KeyPair log, load_server_key(folder.log_key(), ServerKeyRole::log));
    WEAVE_TRY(KeyPair stamp, load_server_key(folder.stamp_key(), ServerKeyRole::stamp));
    WEAVE_TRY(KeyPair access, access_key_of(folder));
    WEAVE_TRY(Store store, Store::open(place, config.standby));
    WEAVE_CHECK_OK(check_tables(place));
    WEAVE_TRY(std::string name, store.read([](const Reader& reader) { return reader.site(); }));
    return OpenSite{std::move(lock), std::move(store), {std::move(log), std::move(stamp), std::move(access)}, std::move(name), false};
}

}  // namespace

std::string SiteFolder::whole_path() const {
    std::error_code unknown;
    return fs::absolute(path, unknown).lexically_normal().string();
}

bool SiteFolder::holds_site() const {
    std::error_code trouble;
    return fs::exists(store_place(), trouble) || fs::exists(own_store(), trouble);
}

Result<std::string> SiteFolder::store() const {
    std::error_code trouble;
    if (!fs::exists(store_place(), trouble)) return own_store().string();
    WEAVE_TRY(std::string place, read_file(store_place(), most_place));
    while (place.ends_with('\n')) place.pop_back();
    if (!is_database(place)) return bad_input("holds no connection string of PostgreSQL", store_place().string());
    return place;
}

Status check_site_folder(const SiteFolder& folder) {
    if (folder.holds_site()) return {};
    WEAVE_TRY(const bool empty, holds_nothing(folder.path));
    if (empty) return {};
    return Error{ErrorCode::refused, "holds no store of loomlink, and is not empty", folder.path.string()};
}

Status check_site(const SiteFolder& folder, const ServeConfig& config) {
    std::error_code trouble;
    if (fs::exists(folder.path, trouble)) WEAVE_CHECK_OK(check_site_folder(folder));
    if (!folder.holds_site()) return config.store.empty() ? Status() : check_store(config.store, true);
    WEAVE_TRY(const std::string place, place_of_store(folder, config));
    WEAVE_CHECK_OK(check_keys(folder, config));
    return check_store(place, false);
}

Result<OpenSite> open_site(const SiteFolder& folder, const ServeConfig& config) {
    std::error_code unknown;
    const bool was_there = fs::exists(folder.path, unknown);
    WEAVE_CHECK_OK(make_service_folder(folder.path));
    WEAVE_CHECK_OK(check_site_folder(folder));
    WEAVE_TRY(FolderLock lock, FolderLock::take(folder.path, "loomlink"));
    if (folder.holds_site()) return open_old_site(std::move(lock), folder, config);
    if (::chmod(folder.path.c_str(), 0700) != 0) return fault(folder.path, "close it to others");
    return make_site(std::move(lock), folder, config, was_there);
}

}  // namespace weave::loomlink
