#include <weave/wire/place.hpp>

#include <weave/core/text.hpp>

#include <algorithm>
#include <utility>

namespace weave::wire {

namespace {

/// `box`, `box:9000` and `[::1]` as an address.
std::string with_scheme(const std::string& text) {
    const std::size_t colon = text.find_last_of(":]");
    const bool has_port = colon != std::string::npos && text[colon] == ':';
    return "https://" + text + (has_port ? "" : ":" + std::to_string(usual_port));
}

std::string bracketed(const std::string& host) {
    return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

bool is_token(std::string_view text) {
    const auto fits = [](char c) {
        const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        return letter || std::string_view("-._~+/=").find(c) != std::string_view::npos;
    };
    return !text.empty() && text.size() <= most_token_bytes && std::ranges::all_of(text, fits);
}

}  // namespace

bool is_this_machine(const std::string& host) {
    const bool in_127 = host.starts_with("127.") && host.find_first_not_of("0123456789.") == std::string::npos;
    return in_127 || host == "::1" || host == "localhost";
}

Result<ServerPlace> place_of(const std::string& text) {
    const bool is_whole = text.find("://") != std::string::npos || text.starts_with("unix:");
    auto options = net::parse_origin(is_whole ? text : with_scheme(text));
    if (!options) return bad_input("is no place of a server: write box, box:8444, https://box:8444 or unix:PATH", on_one_line(text));
    if (text.starts_with("http://") && !is_this_machine(options->host))
        return bad_input("plain HTTP stays within this machine, as everybody on the way could read it: https://", on_one_line(text));
    const bool has_path = text.starts_with("unix:");
    std::string name = has_path ? on_one_line(text) : bracketed(options->host) + ":" + std::to_string(options->port);
    return ServerPlace{std::move(*options), std::move(name), {}};
}

Status use_token(ServerPlace& place, std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r\n");
    const auto last = text.find_last_not_of(" \t\r\n");
    if (first != std::string_view::npos) text = text.substr(first, last - first + 1);
    if (!is_token(text)) return bad_input("is no token: 1 to 4096 letters, digits and -._~+/=", "token");
    place.token = text;
    return {};
}

}  // namespace weave::wire
