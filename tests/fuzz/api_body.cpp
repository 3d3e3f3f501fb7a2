// A request's body and query from anywhere, for any route of the API: refused with the member's name, or what
// the route's fields say and nothing else.
#include "support/must.hpp"

#include <weave/net/target.hpp>

#include <algorithm>
#include <loomlink/service/table.hpp>

using namespace weave;
using namespace weave::loomlink;
using fuzz::must;

namespace {

const std::vector<ApiRoute>& table() {
    static const std::vector<ApiRoute> routes = api_table();
    return routes;
}

void must_fit(const Json& read, const Fields& fields) {
    must(read.is_object(), "what was read is an object");
    for (const auto& [name, value] : read.items()) {
        const auto field = std::find_if(fields.begin(), fields.end(),
                                        [&name = name](const Field& one) { return one.name == name; });
        must(field != fields.end(), "no member but the route's is let in");
        must(!value.is_null(), "null is a member that is missing");
    }
    for (const Field& field : fields)
        must(!field.required || read.contains(field.name), "no member that must be there is missing");
}

void try_body(std::string_view text, const Fields& fields) {
    const auto read = read_body(text, fields);
    if (!read) {
        must(!read.error().message.empty(), "a refusal says why");
        return;
    }
    must_fit(*read, fields);
    const std::string written = canonical_json(*read);
    const auto again = read_body(written, fields);
    must(again && canonical_json(*again) == written, "what was read reads the same again");
}

void try_query(std::string_view text, const Fields& fields) {
    const auto query = net::parse_query(text);
    if (!query) return;
    if (const auto read = read_query(*query, fields)) must_fit(*read, fields);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const ApiRoute& route = table()[data[0] % table().size()];
    const std::string_view text = fuzz::text_of(data + 1, size - 1);
    try_body(text, route.body);
    try_query(text, route.query);
    return 0;
}
