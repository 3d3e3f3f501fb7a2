#include <loomlink/service/page.hpp>

#include <weave/core/sha256.hpp>

#include <algorithm>
#include <cassert>
#include <memory>
#include <string>

namespace weave::loomlink {

namespace {

/// The page loads what comes with it and talks to its own server, no more. Pictures that it draws are blobs.
constexpr const char* page_policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; "
    "form-action 'self'; base-uri 'none'; frame-ancestors 'none'";

std::string type_of(std::string_view path) {
    if (path.ends_with(".html")) return "text/html; charset=utf-8";
    if (path.ends_with(".js")) return "text/javascript; charset=utf-8";
    if (path.ends_with(".css")) return "text/css; charset=utf-8";
    if (path.ends_with(".svg")) return "image/svg+xml";
    return "text/plain; charset=utf-8";
}

net::Handler serving(const PageFile& file) {
    const auto text = net::make_bytes(std::string(file.text));
    const auto etag = net::etag_of(sha256_hex(*text));
    return [text, etag, type = type_of(file.path)](const net::Request& request) {
        net::Response response = net::answer(200, type, text);
        if (net::holds_already(request, etag)) {
            response = net::Response{304, {}, nullptr};
        }
        response.headers.set("ETag", etag);
        response.headers.set("Cache-Control", "no-cache");  // asks each time, so that an update arrives
        response.headers.set("Content-Security-Policy", page_policy);
        return response;
    };
}

bool is_for_the_api(const net::Request& request) {
    return request.path == "/api" || request.path.starts_with("/api/");
}

}  // namespace

std::vector<net::Route> page_routes() {
    std::vector<net::Route> routes;
    const auto files = page_files();
    for (const PageFile& file : files) {
        const std::string path(file.path);
        routes.push_back({"page." + path, "GET", "/" + path, "A file of the page", 0, serving(file), {}});
    }
    const auto index =
        std::find_if(files.begin(), files.end(), [](const PageFile& f) { return f.path == "index.html"; });
    assert(index != files.end());
    const auto show = serving(*index);
    const auto show_or_miss = [show](const net::Request& request) {
        if (!is_for_the_api(request)) return show(request);
        return net::error_answer(bad_input("there is nothing here"), 404);
    };
    routes.push_back({"page", "GET", "/", "The page", 0, show, {}});
    std::string pattern;
    for (std::size_t depth = 1; depth <= deepest_page_path; ++depth) {
        pattern += "/{p" + std::to_string(depth) + "}";
        routes.push_back({"page." + std::to_string(depth), "GET", pattern, "The page", 0, show_or_miss, {}});
    }
    return routes;
}

}  // namespace weave::loomlink
