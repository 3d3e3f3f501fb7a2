// The head of a request from anywhere, and what stands in it: target, query, cookies, framing and host.
#include "support/must.hpp"

#include <weave/core/text.hpp>
#include <weave/net/heads.hpp>
#include <weave/net/target.hpp>

#include <algorithm>

using namespace weave;
using fuzz::must;

namespace {

bool is_plain_text(const std::string& text) {
    return is_utf8(text) && std::none_of(text.begin(), text.end(), [](char c) {
               const auto byte = static_cast<unsigned char>(c);
               return byte < 0x20 || byte == 0x7f;
           });
}

void try_target(std::string_view text) {
    const auto target = net::parse_target(text);
    if (!target) {
        must(!target.error().message.empty(), "a refusal says why");
        return;
    }
    must(target->path.starts_with('/') && is_plain_text(target->path),
         "a path is text, and begins with a slash");
    must((target->path + "/").find("/../") == std::string::npos, "no path goes up");
    must(target->query.size() <= 64, "a query has its bounds");
    for (const auto& [name, value] : target->query)
        must(is_plain_text(name) && is_plain_text(value), "a parameter is text");
}

void try_percent(std::string_view text) {
    const auto decoded = net::percent_decoded(text);
    if (!decoded) return;
    const auto again = net::percent_decoded(net::percent_encoded(*decoded));
    must(again && *again == *decoded, "what is encoded is decoded again");
}

/// The lines as header fields, split at their first colon.
net::Headers fields_of(std::string_view text) {
    net::Headers headers;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        const std::size_t colon = line.find(':');
        if (colon != std::string_view::npos)
            headers.add(std::string(line.substr(0, colon)), std::string(line.substr(colon + 1)));
    }
    return headers;
}

void try_fields(std::string_view text) {
    net::Request request;
    request.headers = fields_of(text);
    for (const bool old : {false, true}) {
        if (const auto framing = net::framing_of(request.headers, old))
            must(!framing->chunked || (framing->length == 0 && !old), "a body is delimited in one way");
        if (const auto host = net::host_of(request.headers, old))
            must(host->find('/') == std::string::npos, "a host is a name");
    }
    static_cast<void>(request.cookie("loomlink"));
    static_cast<void>(net::holds_already(request, net::etag_of("00")));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::text_of(data, size);
    if (net::check_head(text)) must(text.ends_with("\r\n\r\n"), "a head ends with an empty line");
    try_target(text);
    try_percent(text);
    try_fields(text);
    return 0;
}
