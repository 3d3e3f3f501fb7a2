#include <weave/core/file.hpp>
#include <weave/core/json_reader.hpp>
#include <weave/core/text.hpp>
#include <weave/keys/private_file.hpp>
#include <weave/keys/signer.hpp>
#include <weave/net/certificate.hpp>

#include <algorithm>
#include <simd/commands/config.hpp>
#include <thread>
#include <unistd.h>

namespace weave::simd {

namespace {

constexpr std::uint64_t mib = std::uint64_t{1} << 20;

std::vector<std::string> texts_of(JsonReader& reader, const char* key, std::size_t most) {
    std::vector<std::string> texts;
    if (!reader.has(key)) return texts;
    const Json& list = reader.raw(key);
    if (!list.is_array() || list.size() > most) {
        reader.fail("must be a list of at most " + std::to_string(most) + " texts", key);
        return texts;
    }
    for (std::size_t k = 0; k < list.size(); ++k) {
        if (list[k].is_string()) texts.push_back(list[k].get<std::string>());
        else reader.fail("must be a text", indexed(key, k));
    }
    return texts;
}

std::vector<PublicKey> keys_of(JsonReader& reader) {
    std::vector<PublicKey> keys;
    const std::vector<std::string> texts = texts_of(reader, "access_keys", 8);
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

bool is_loopback(const std::string& address) {
    return address == "::1" || address.starts_with("127.");
}

}  // namespace

Result<ServeConfig> parse_config(std::string_view text) {
    constexpr std::int64_t most_mib = std::int64_t{1} << 30, week = 7 * 24 * 3600;
    WEAVE_TRY(const Json json, parse_json(text));
    JsonReader reader(json, "");
    ServeConfig config;
    config.address = reader.text("address", config.address, 64);
    config.port = static_cast<std::uint16_t>(reader.integer("port", 0, 65535, config.port));
    config.hosts = texts_of(reader, "hosts", 32);
    config.certificate = reader.text("certificate", std::string(), 4096);
    config.key = reader.text("key", std::string(), 4096);
    config.plain = reader.boolean("plain", config.plain);
    config.unix_socket = reader.text("unix_socket", std::string(), 4096);
    config.workers = count_of(reader, "workers", 1, 64, config.workers);
    config.threads = count_of(reader, "threads", 0, 1024, 0);
    config.memory_bytes = static_cast<std::uint64_t>(reader.integer("memory_mib", 0, most_mib, 0)) * mib;
    config.sessions = count_of(reader, "sessions", 1, 10000, config.sessions);
    config.sessions_per_person = count_of(reader, "sessions_per_person", 1, 1000, config.sessions_per_person);
    config.jobs_at_once = count_of(reader, "jobs_at_once", 1, 1000, config.jobs_at_once);
    config.jobs_per_person = count_of(reader, "jobs_per_person", 1, 10000, config.jobs_per_person);
    config.expire_seconds = reader.integer("expire_seconds", 1, week, config.expire_seconds);
    config.stall_seconds = reader.integer("stall_seconds", 1, week, config.stall_seconds);
    config.site = reader.text("site", std::string(), 200);
    config.access_keys = keys_of(reader);
    config.evidence_key = reader.text("evidence_key", std::string(), 4096);
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    WEAVE_CHECK_OK(check_config(config));
    return config;
}

Result<ServeConfig> load_config(const std::filesystem::path& file) {
    constexpr std::uint64_t most_bytes = 65536;
    WEAVE_TRY(const std::string text, read_file(file, most_bytes));
    auto config = parse_config(text);
    if (!config) return std::move(config).error().in(file.string());
    for (auto* path : {&config->certificate, &config->key, &config->unix_socket, &config->evidence_key})
        if (!path->empty() && path->is_relative()) *path = file.parent_path() / *path;
    return config;
}

Status check_config(const ServeConfig& config) {
    if (config.certificate.empty() != config.key.empty())
        return bad_input("certificate and key go together", config.key.empty() ? "key" : "certificate");
    if (config.plain && !config.certificate.empty()) return bad_input("goes with no certificate: HTTP without TLS needs none", "plain");
    if (config.plain && !config.address.empty() && !is_loopback(config.address))
        return bad_input("without TLS it serves this machine alone: 127.0.0.1 or ::1", "address");
    if (!config.site.empty() && config.access_keys.empty()) return bad_input("counts for tokens of its keys: give access_keys too", "site");
    if (config.site.empty() && !config.access_keys.empty()) return bad_input("are of a site: give its name too", "access_keys");
    return {};
}

Status check_places(const ServeConfig& config) {
    if (!config.certificate.empty()) {
        if (const auto read = net::read_certificate(config.certificate); !read) return Error(read.error()).under("certificate");
        if (const Status closed = check_private_file(config.key); !closed) return Error(closed.error()).under("key");
    }
    if (!config.evidence_key.empty()) {
        if (const auto signer = load_signer(config.evidence_key); !signer) return Error(signer.error()).under("evidence_key");
    }
    return {};
}

std::size_t threads_of(const ServeConfig& config) {
    return config.threads > 0 ? config.threads : std::max(1U, std::thread::hardware_concurrency());
}

std::uint64_t memory_of(const ServeConfig& config) {
    if (config.memory_bytes > 0) return config.memory_bytes;
    const auto pages = static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PHYS_PAGES))), page = static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PAGESIZE)));
    return pages * page / 5 * 4;
}

}  // namespace weave::simd
