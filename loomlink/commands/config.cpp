#include <loomlink/commands/config.hpp>

#include <weave/core/text.hpp>

#include <loomlink/store/server.hpp>
#include <utility>

namespace weave::loomlink {

Result<ServeConfig> parse_config(std::string_view text, const std::filesystem::path& folder) {
    WEAVE_TRY(const Json json, parse_json(text));
    JsonReader reader(json, "");
    ServeConfig config;
    read_service(reader, folder, config);
    config.site = reader.text("site", config.site, 200);
    config.store = reader.text("store", config.store, 2000);
    config.standby = reader.text("standby", config.standby, 2000);
    config.heads = path_member(reader, "heads", folder);
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    WEAVE_CHECK_OK(check_config(config));
    return config;
}

Status check_config(const ServeConfig& config) {
    if (config.site.empty() || on_one_line(config.site) != config.site)
        return bad_input("must be a name on one line", "site");
    for (const auto& [member, place] : {std::pair("store", config.store), std::pair("standby", config.standby)})
        if (const Status known = place.empty() ? Status() : check_connection_string(place); !known)
            return std::move(Error(known.error())).in(member);
    if (config.address.empty()) return bad_input("must be an address to listen on", "address");
    return check_service(config);
}

}  // namespace weave::loomlink
