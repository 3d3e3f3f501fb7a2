#include <weave/sql/postgres_connection.hpp>

#include <cctype>

namespace weave::sql {

namespace {

struct OptionsFreed {
    void operator()(PQconninfoOption* options) const { PQconninfoFree(options); }
};
using Options = std::unique_ptr<PQconninfoOption, OptionsFreed>;

/// A place as libpq understands it. What libpq says of one that it does not could hold a part of a password.
Result<Options> options_of(const std::string& place) {
    Options options(PQconninfoParse(place.c_str(), nullptr));
    if (!options) return bad_input("is no connection string of PostgreSQL, such as postgresql://db.mill.example/mill");
    for (const PQconninfoOption* one = options.get(); one->keyword != nullptr; ++one)
        if (one->val != nullptr && std::string_view(one->keyword).ends_with("password"))
            return bad_input("a connection string must hold no password: it belongs into a file of mode 0600 (passfile=…, or "
                             "PGPASSFILE)");
    return options;
}

std::vector<std::string> split(const std::string& list) {
    std::vector<std::string> parts;
    std::size_t from = 0;
    for (std::size_t comma = list.find(','); comma != std::string::npos; comma = list.find(',', from)) {
        parts.push_back(list.substr(from, comma - from));
        from = comma + 1;
    }
    parts.push_back(list.substr(from));
    return parts;
}

std::string in_percents(const std::string& text) {
    constexpr std::string_view digits = "0123456789ABCDEF";
    std::string words;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isalnum(byte) != 0)
            words += c;
        else
            (words += '%') += {digits[byte >> 4], digits[byte & 15]};
    }
    return words;
}

}  // namespace

Result<std::unique_ptr<Connection>> open_postgres(const std::string& place, Access access, std::chrono::milliseconds patience) {
    WEAVE_CHECK_OK(options_of(place));
    const char* const kind = access == Access::standby ? "prefer-standby" : "read-write";
    // What stands before `dbname` the place may say otherwise, what stands behind it may not: by its name a program is known to one
    // that asks whether the database is in use. A way that is dead is to be
    // noticed in seconds, not when TCP gives up.
    const std::array keywords{"connect_timeout",     "keepalives_idle", "keepalives_interval", "keepalives_count",
                              "tcp_user_timeout", "dbname", "application_name", "client_encoding", "target_session_attrs", static_cast<const char*>(nullptr)};
    const std::array values{"5", "5", "2", "3", "10000", place.c_str(), "weave", "UTF8", kind, static_cast<const char*>(nullptr)};
    auto connection = std::make_unique<PostgresConnection>(PQconnectdbParams(keywords.data(), values.data(), 1), place, patience);
    if (!connection->is_usable()) return connection->lost();
    WEAVE_CHECK_OK(connection->configure(access));
    return std::unique_ptr<Connection>(std::move(connection));
}

Result<std::vector<std::string>> servers_of(const std::string& place) {
    WEAVE_TRY(const Options options, options_of(place));
    std::vector<std::string> hosts{""}, ports{""};
    std::string rest;
    for (const PQconninfoOption* one = options.get(); one->keyword != nullptr; ++one) {
        const std::string keyword = one->keyword;
        if (one->val == nullptr || keyword == "target_session_attrs") continue;
        if (keyword == "host" || keyword == "hostaddr")
            hosts = split(one->val);
        else if (keyword == "port")
            ports = split(one->val);
        else
            rest += "&" + keyword + "=" + in_percents(one->val);
    }
    std::vector<std::string> places;
    for (std::size_t k = 0; k < hosts.size(); ++k)
        places.push_back("postgresql:///?host=" + in_percents(hosts[k]) + "&port=" + ports[std::min(k, ports.size() - 1)] + rest);
    return places;
}

}  // namespace weave::sql
