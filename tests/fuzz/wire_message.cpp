// A control message from anywhere, read as a client's and as the server's: refused, or one that reads as it is written.
#include "support/must.hpp"

#include <weave/core/json.hpp>
#include <weave/wire/message.hpp>

using namespace weave;
using namespace weave::wire;
using fuzz::must;

namespace {

template <class Message>
void check(std::string_view text, Result<Message> (*read)(std::string_view)) {
    const auto message = read(text);
    if (!message) {
        must(!message.error().message.empty() && !message.error().where.empty(), "a refusal says why and where");
        return;
    }
    const std::string written = write_message(*message);
    const auto again = read(written);
    must(again && write_message(*again) == written, "a message reads as it was written");
    const auto json = parse_json(text);
    must(json && canonical_json(*json) == written, "a message holds all that the text said");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::text_of(data, size);
    check<ClientMessage>(text, read_client_message);
    check<ServerMessage>(text, read_server_message);
    if (const auto request = request_of(text)) must(request->size() >= 8 && request->size() <= 64, "an id has its form");
    return 0;
}
