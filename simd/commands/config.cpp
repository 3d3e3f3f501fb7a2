#include <simd/commands/config.hpp>

#include <weave/core/text.hpp>
#include <weave/sim/backend.hpp>

#include <algorithm>
#include <cctype>
#include <simd/daemon/room.hpp>
#include <thread>
#include <unistd.h>

namespace weave::simd {

namespace {

constexpr std::uint64_t mib = std::uint64_t{1} << 20;

std::vector<PublicKey> keys_of(JsonReader& reader) {
    std::vector<PublicKey> keys;
    const std::vector<std::string> texts = reader.texts("access_keys", 8);
    for (std::size_t k = 0; k < texts.size(); ++k) {
        auto key = parse_public_key(texts[k]);
        if (key) keys.push_back(*key);
        else reader.fail(key.error().message, indexed("access_keys", k));
    }
    return keys;
}

std::size_t count_of(JsonReader& reader, const char* key, std::int64_t low, std::int64_t high, std::size_t usual) {
    return static_cast<std::size_t>(reader.integer(key, low, high, static_cast<std::int64_t>(usual)));
}

/// A word of a site's, as sbatch takes it.
std::string slurm_word(JsonReader& reader, const char* key) {
    constexpr std::size_t longest = 100;
    std::string word = reader.text(key, std::string(), longest);
    const bool fits = std::ranges::all_of(word, [](unsigned char c) { return std::isalnum(c) != 0 || std::string_view("_-.,:=+/@").find(static_cast<char>(c)) != std::string_view::npos; });
    if (!fits || word.starts_with('-')) reader.fail("must be a word of letters, digits and _ . , : = + / @ -", key);
    return word;
}

std::optional<SlurmConfig> slurm_of(JsonReader& reader, const std::filesystem::path& folder) {
    constexpr std::int64_t day = 24 * 3600, most_minutes = 366 * 24 * 60, most_mib = std::int64_t{1} << 30;
    if (!reader.has("slurm")) return {};
    JsonReader inner = reader.object("slurm");
    SlurmConfig config;
    config.folder = path_member(inner, "folder", folder);
    if (config.folder.empty()) inner.fail("name a folder that this machine and all nodes see", "folder");
    config.program = path_member(inner, "program", folder);
    config.wishes.partition = slurm_word(inner, "partition");
    config.wishes.account = slurm_word(inner, "account");
    config.wishes.qos = slurm_word(inner, "qos");
    config.wishes.gres = slurm_word(inner, "gres");
    config.wishes.cpus = count_of(inner, "cpus", 1, 1024, config.wishes.cpus);
    config.wishes.memory_mib = count_of(inner, "memory_mib", 0, most_mib, 0);
    config.wishes.minutes = count_of(inner, "minutes", 0, most_minutes, 0);
    config.jobs_at_once = count_of(inner, "jobs_at_once", 1, 1000, config.jobs_at_once);
    config.watch_seconds = inner.integer("watch_seconds", 1, day, config.watch_seconds);
    config.checkpoint_seconds = inner.integer("checkpoint_seconds", 1, day, config.checkpoint_seconds);
    inner.no_others();
    return config;
}

/// A device that is asked for must be there.
Status check_backend(const std::string& name) {
    const Result<sim::Backend> backend = sim::parse_backend(name);
    if (!backend) return bad_input(std::string(backend.error().message), "backend");
    const auto choice = sim::choose_backend(*backend, sim::SimScene());
    return choice ? Status() : Status(Error{choice.error().code, choice.error().message, "backend"});
}

}  // namespace

Result<ServeConfig> parse_config(std::string_view text, const std::filesystem::path& folder) {
    constexpr std::int64_t most_mib = std::int64_t{1} << 30, week = 7 * 24 * 3600;
    WEAVE_TRY(const Json json, parse_json(text));
    JsonReader reader(json, "");
    ServeConfig config;
    read_service(reader, folder, config);
    config.unix_socket = path_member(reader, "unix_socket", folder);
    config.threads = count_of(reader, "threads", 0, 1024, 0);
    config.backend = reader.text("backend", config.backend, 16);
    config.memory_bytes = static_cast<std::uint64_t>(reader.integer("memory_mib", 0, most_mib, 0)) * mib;
    config.sessions = count_of(reader, "sessions", 1, 10000, config.sessions);
    config.sessions_per_person = count_of(reader, "sessions_per_person", 1, 1000, config.sessions_per_person);
    config.jobs_at_once = count_of(reader, "jobs_at_once", 1, 1000, config.jobs_at_once);
    config.jobs_per_person = count_of(reader, "jobs_per_person", 1, 10000, config.jobs_per_person);
    config.expire_seconds = reader.integer("expire_seconds", 1, week, config.expire_seconds);
    config.stall_seconds = reader.integer("stall_seconds", 1, week, config.stall_seconds);
    config.site = reader.text("site", std::string(), 200);
    config.access_keys = keys_of(reader);
    config.slurm = slurm_of(reader, folder);
    config.evidence_key = path_member(reader, "evidence_key", folder);
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    WEAVE_CHECK_OK(check_config(config));
    return config;
}

Status check_config(const ServeConfig& config) {
    WEAVE_CHECK_OK(check_service(config));
    WEAVE_CHECK_OK(check_backend(config.backend));
    if (config.memory_bytes > 0 && config.memory_bytes < expected_bytes(1))
        return bad_input("is less than the smallest cloth needs: at least " + std::to_string(expected_bytes(1) / mib + 1), "memory_mib");
    if (!config.site.empty() && config.access_keys.empty()) return bad_input("counts for tokens of its keys: give access_keys too", "site");
    if (config.site.empty() && !config.access_keys.empty()) return bad_input("are of a site: give its name too", "access_keys");
    return {};
}

std::size_t threads_of(const ServeConfig& config) {
    return config.threads > 0 ? config.threads : std::max(1U, std::thread::hardware_concurrency());
}

std::uint64_t machine_memory() {
    const auto pages = static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PHYS_PAGES))), page = static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PAGESIZE)));
    return pages * page;
}

std::uint64_t memory_of(const ServeConfig& config) {
    return config.memory_bytes > 0 ? config.memory_bytes : machine_memory() / 5 * 4;
}

}  // namespace weave::simd
