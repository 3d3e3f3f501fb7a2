#include <weave/wire/server_room.hpp>

#include <weave/core/json_reader.hpp>
#include <weave/wire/client.hpp>

#include <chrono>
#include <limits>

namespace weave::wire {

namespace {

/// How long a server may take to say what it has: to be told that early is a help, no more.
constexpr std::chrono::seconds patience{5};

}  // namespace

Result<sim::MemoryRoom> room_on(const ServerPlace& place) {
    constexpr std::uint64_t most_bytes = std::uint64_t{16} << 20;
    ServerPlace hasty = place;
    hasty.options.connect_time = hasty.options.answer_time = patience;
    WEAVE_TRY(const std::string text, download(hasty, "/api/v1/status", most_bytes));
    WEAVE_TRY(const Json status, parse_json(text));
    JsonReader reader(status, "");
    JsonReader memory = reader.object("memory");
    const std::int64_t bytes = memory.integer("bytes", 0, std::numeric_limits<std::int64_t>::max());
    WEAVE_CHECK_OK(reader.status());
    return sim::MemoryRoom{static_cast<std::uint64_t>(bytes), place.name};
}

}  // namespace weave::wire
