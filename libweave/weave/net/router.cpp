#include <weave/net/router.hpp>

#include <algorithm>
#include <array>
#include <set>

namespace weave::net {

namespace {

std::vector<std::string_view> segments_of(std::string_view path) {
    std::vector<std::string_view> segments;
    if (path.size() < 2) return segments;
    path.remove_prefix(1);
    while (true) {
        const std::size_t slash = path.find('/');
        segments.push_back(path.substr(0, slash));
        if (slash == std::string_view::npos) return segments;
        path.remove_prefix(slash + 1);
    }
}

bool is_place(std::string_view segment) {
    return segment.size() > 2 && segment.front() == '{' && segment.back() == '}';
}

std::string_view place_name(std::string_view segment) {
    return segment.substr(1, segment.size() - 2);
}

bool is_well_formed(std::string_view pattern) {
    if (pattern.empty() || pattern.front() != '/') return false;
    std::set<std::string_view> names;
    for (const std::string_view segment : segments_of(pattern)) {
        if (segment.empty()) return false;
        const std::string_view inner = is_place(segment) ? place_name(segment) : segment;
        if (inner.find_first_of("{}?%#") != std::string_view::npos) return false;
        if (is_place(segment) && !names.insert(inner).second) return false;
    }
    return true;
}

/// Two patterns that no path tells apart.
bool same_shape(std::string_view a, std::string_view b) {
    const auto x = segments_of(a), y = segments_of(b);
    return std::equal(x.begin(), x.end(), y.begin(), y.end(), [](std::string_view s, std::string_view t) {
        return (is_place(s) && is_place(t)) || s == t;
    });
}

bool fits(const std::vector<std::string_view>& pattern, const std::vector<std::string_view>& path) {
    return std::equal(pattern.begin(), pattern.end(), path.begin(), path.end(),
                      [](std::string_view s, std::string_view t) { return is_place(s) || s == t; });
}

/// Whether pattern `a` is literal where `b`, which fits the same path, first differs from it.
bool is_closer(const std::vector<std::string_view>& a, const std::vector<std::string_view>& b) {
    for (std::size_t k = 0; k < a.size(); ++k)
        if (is_place(a[k]) != is_place(b[k])) return is_place(b[k]);
    return false;
}

Parameters places_of(const std::vector<std::string_view>& pattern,
                     const std::vector<std::string_view>& path) {
    Parameters places;
    for (std::size_t k = 0; k < pattern.size(); ++k)
        if (is_place(pattern[k])) places.emplace_back(place_name(pattern[k]), path[k]);
    return places;
}

}  // namespace

Status Router::add(Route route) {
    static constexpr std::array<std::string_view, 5> methods{"GET", "POST", "PUT", "PATCH", "DELETE"};
    const auto wrong = [&](const std::string& why) { return Error{ErrorCode::usage, why, route.pattern}; };
    if (!is_well_formed(route.pattern)) return wrong("is no pattern of a route");
    if (std::find(methods.begin(), methods.end(), route.method) == methods.end())
        return wrong("is a route of no known method");
    if (static_cast<bool>(route.handler) == static_cast<bool>(route.admission))
        return wrong("a route has a handler, or the admission of a WebSocket");
    if (route.admission && route.method != "GET") return wrong("a WebSocket's route is reached by GET");
    for (const Route& other : m_routes) {
        if (other.name == route.name) return wrong("another route is called " + route.name);
        if (other.method == route.method && same_shape(other.pattern, route.pattern))
            return wrong("another route answers the same requests");
    }
    m_routes.push_back(std::move(route));
    return {};
}

RouteMatch Router::match(std::string_view method, std::string_view path) const {
    const std::string_view wanted = method == "HEAD" ? "GET" : method;
    const auto segments = segments_of(path);
    RouteMatch match;
    std::vector<std::string_view> best;
    std::set<std::string> allowed;
    for (const Route& route : m_routes) {
        auto pattern = segments_of(route.pattern);
        if (!fits(pattern, segments)) continue;
        allowed.insert(route.method);
        if (route.method == "GET" && route.handler) allowed.insert("HEAD");
        if (route.method != wanted || (method == "HEAD" && route.admission)) continue;
        if (match.route != nullptr && !is_closer(pattern, best)) continue;
        match.route = &route;
        best = std::move(pattern);
    }
    if (match.route != nullptr)
        match.places = places_of(best, segments);
    else
        match.allowed.assign(allowed.begin(), allowed.end());
    return match;
}

}  // namespace weave::net
