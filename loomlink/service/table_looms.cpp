#include <weave/block/card_image.hpp>

#include <loomlink/service/table.hpp>

namespace weave::loomlink {

namespace {

constexpr std::int64_t most_profile_bytes = 1 << 20;
constexpr std::int64_t most_number = 1 << 30;

const Field reason{"reason", "Why; it stands in the log", FieldKind::text, true, 1, 4000};
const Field password{
    "password", "The password, typed again for this one signature", FieldKind::secret, true, 1, 1024};
const Field profile{"profile",         "The JSON of the loom's profile", FieldKind::document, true, 2,
                    most_profile_bytes};

Access admin() {
    return access::only({PersonRole::administrator});
}
Access operators() {
    return access::only({PersonRole::operator_});
}

Field number(const std::string& name, const std::string& description) {
    return {name, description, FieldKind::integer, true, 1, most_number};
}

std::vector<ApiRoute> site_table() {
    return {
        {"looms", "GET", "/looms", access::signed_in(), "The looms that are open to the caller",
         "`looms`: `name`, `profile_name`, `released`, `loaded`"},
        {"loom.make",
         "POST",
         "/looms",
         admin(),
         "Adds a loom",
         "`name`, `profile_version`",
         {},
         with_request({{"name", "What the loom is called", FieldKind::text, true, 1, 64}, profile}),
         "application/json",
         2 * most_profile_bytes},
        {"loom", "GET", "/looms/{loom}", access::signed_in(),
         "A loom: its profile, operators, releases and faults", "The members that API.md names"},
        {"loom.profile",
         "PUT",
         "/looms/{loom}/profile",
         admin(),
         "Puts a new version of the profile in force; releases for older ones can no longer be pulled",
         "`profile_version`",
         {},
         with_request({profile}),
         "application/json",
         2 * most_profile_bytes},
        {"loom.operators",
         "PUT",
         "/looms/{loom}/operators",
         admin(),
         "Says who works at a loom",
         "`operators`",
         {},
         with_request({{"operators", "Their names", FieldKind::texts, true, 0, 200}})},
        {"loom.index",
         "GET",
         "/looms/{loom}/index",
         access::readers_and_operators(),
         "What is released for a loom now, signed for some hours",
         "`index`, `trust`: documents after the version given, `consistency`: proof from the head given",
         {optional(number("trust", "The version of the trust document that the terminal has")),
          optional(number("head", "The size of the log that the terminal saw"))}},
        {"loom.place",
         "PUT",
         "/looms/{loom}/place",
         operators(),
         "Remembers the last woven pick",
         "`release`, `pick`",
         {},
         with_request({number("release", "The release"), number("pick", "The pick")})},
        {"loom.loaded",
         "POST",
         "/looms/{loom}/loaded",
         operators(),
         "Confirms that a release is loaded",
         "`release`",
         {},
         with_request({number("release", "The release")})},
        {"loom.fault",
         "POST",
         "/looms/{loom}/faults",
         operators(),
         "Reports a fault to the designer",
         "`at`",
         {},
         with_request({number("release", "The release"),
                       optional(number("pick", "The pick")),
                       optional(number("end", "The end")),
                       {"text", "What is wrong", FieldKind::text, true, 1, 4000}})},
        {"loom.faults", "GET", "/looms/{loom}/faults", access::readers_and_operators(),
         "The faults that were reported", "`faults`: `release`, `pick`, `end`, `text`, `by`, `at`"},
    };
}

std::vector<ApiRoute> release_table() {
    const std::string root = "/looms/{loom}/releases/{n}";
    return {
        {"release", "GET", root, access::readers_and_operators(),
         "A release: what it is bound to, its files, its state", "The members that API.md names"},
        {"release.manifest",
         "GET",
         root + "/manifest",
         access::readers_and_operators(),
         "The signed manifest of a release; a pull is logged",
         "The manifest, byte by byte",
         {},
         {},
         "application/octet-stream"},
        {"release.file",
         "GET",
         root + "/files/{name}",
         access::readers_and_operators(),
         "A file of a release; a pull is logged",
         "The file",
         {},
         {},
         "application/octet-stream"},
        {"release.picks",
         "GET",
         root + "/picks",
         access::readers_and_operators(),
         "Picks of a release in the order of insertion",
         "`picks`: `pick`, `feeder`, `direction`, `yarn`, `colour`, `take_up`",
         {number("from", "The first pick, from 1"),
          {"count", "How many", FieldKind::integer, true, 1, 1000}}},
        {"release.sign",
         "POST",
         root + "/sign",
         access::only({PersonRole::approver}),
         "Signs a release that waits for another signature",
         "`state`",
         {},
         with_request({reason, password})},
        {"release.withdraw",
         "POST",
         root + "/withdraw",
         access::only({PersonRole::approver, PersonRole::engineer}),
         "Recalls a release",
         "`state`",
         {},
         with_request({reason, password})},
    };
}

}  // namespace

ApiRoute card_route(const std::string& name, const std::string& path, const Access& who) {
    const auto most = static_cast<std::int64_t>(most_yarns);
    return {name,
            "GET",
            path,
            who,
            "A part of the card image; black is a lifted end",
            "PNG",
            {{"x", "Ends left of the part", FieldKind::integer, true, 0, most},
             {"y", "Picks above the part; the last pick is the top row", FieldKind::integer, true, 0, most},
             {"w", "Ends of the part", FieldKind::integer, true, 1, most},
             {"h", "Picks of the part", FieldKind::integer, true, 1, most},
             optional({"scale", "So many ends and picks share a pixel", FieldKind::integer, true, 1, most})},
            {},
            "image/png"};
}

std::vector<ApiRoute> loom_table() {
    std::vector<ApiRoute> table = site_table();
    const auto releases = release_table();
    table.insert(table.end(), releases.begin(), releases.end());
    table.push_back(
        card_route("release.card", "/looms/{loom}/releases/{n}/card", access::readers_and_operators()));
    ApiRoute watch{"loom.watch",
                   "GET",
                   "/looms/{loom}/watch",
                   access::readers_and_operators(),
                   "A WebSocket that tells whenever the release index of a loom changes",
                   "A message `loom`, `changed` at each change"};
    watch.is_socket = true;
    table.push_back(std::move(watch));
    return table;
}

}  // namespace weave::loomlink
