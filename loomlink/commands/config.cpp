#include <weave/core/file.hpp>
#include <weave/core/json_reader.hpp>
#include <weave/core/text.hpp>

#include <algorithm>
#include <array>
#include <loomlink/commands/config.hpp>
#include <unistd.h>

namespace weave::loomlink {

namespace {

std::vector<std::string> hosts_of(JsonReader& reader) {
    std::vector<std::string> hosts;
    if (!reader.has("hosts")) return hosts;
    const Json& list = reader.raw("hosts");
    if (!list.is_array() || list.size() > 32) {
        reader.fail("must be a list of at most 32 names", "hosts");
        return hosts;
    }
    for (std::size_t k = 0; k < list.size(); ++k) {
        if (list[k].is_string())
            hosts.push_back(list[k].get<std::string>());
        else
            reader.fail("must be a text", indexed("hosts", k));
    }
    return hosts;
}

bool is_everywhere(const std::string& address) {
    return address == "0.0.0.0" || address == "::";
}

}  // namespace

Result<ServeConfig> parse_config(std::string_view text) {
    WEAVE_TRY(const Json json, parse_json(text));
    JsonReader reader(json, "");
    ServeConfig config;
    config.site = reader.text("site", config.site, 200);
    config.address = reader.text("address", config.address, 64);
    config.port = static_cast<std::uint16_t>(reader.integer("port", 0, 65535, config.port));
    config.hosts = hosts_of(reader);
    config.certificate = reader.text("certificate", std::string(), 4096);
    config.key = reader.text("key", std::string(), 4096);
    config.plain = reader.boolean("plain", config.plain);
    config.workers = static_cast<std::size_t>(reader.integer("workers", 1, 64, 4));
    config.heads = reader.text("heads", std::string(), 4096);
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
    for (auto* path : {&config->certificate, &config->key, &config->heads})
        if (!path->empty() && path->is_relative()) *path = file.parent_path() / *path;
    return config;
}

Status check_config(const ServeConfig& config) {
    if (config.site.empty() || on_one_line(config.site) != config.site)
        return bad_input("must be a name on one line", "site");
    if (config.certificate.empty() != config.key.empty())
        return bad_input("certificate and key go together", config.key.empty() ? "key" : "certificate");
    if (config.plain && !config.certificate.empty())
        return bad_input("goes with no certificate: HTTP without TLS needs none", "plain");
    return {};
}

std::vector<std::string> client_hosts(const ServeConfig& config) {
    std::vector<std::string> hosts = config.hosts;
    if (hosts.empty()) {
        std::array<char, 256> name{};
        if (::gethostname(name.data(), name.size() - 1) == 0 && name[0] != '\0')
            hosts.emplace_back(name.data());
        hosts.insert(hosts.end(), {"localhost", "127.0.0.1", "::1"});
    }
    if (!is_everywhere(config.address) &&
        std::find(hosts.begin(), hosts.end(), config.address) == hosts.end())
        hosts.push_back(config.address);
    return hosts;
}

}  // namespace weave::loomlink
