#include <loomlink/commands/config.hpp>

#include <weave/core/text.hpp>

namespace weave::loomlink {

Result<ServeConfig> parse_config(std::string_view text, const std::filesystem::path& folder) {
    WEAVE_TRY(const Json json, parse_json(text));
    JsonReader reader(json, "");
    ServeConfig config;
    read_service(reader, folder, config);
    config.site = reader.text("site", config.site, 200);
    config.heads = path_member(reader, "heads", folder);
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    WEAVE_CHECK_OK(check_config(config));
    return config;
}

Status check_config(const ServeConfig& config) {
    if (config.site.empty() || on_one_line(config.site) != config.site)
        return bad_input("must be a name on one line", "site");
    if (config.address.empty()) return bad_input("must be an address to listen on", "address");
    return check_service(config);
}

}  // namespace weave::loomlink
