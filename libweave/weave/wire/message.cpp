#include <weave/wire/message.hpp>

#include <weave/wire/message_parts.hpp>

namespace weave::wire {

namespace {

/// `type` of each message, in the order of the variants.
const form::Names client_types{"hello",      "create", "attach",      "run",    "pause",  "step",   "change", "read_state",
                               "checkpoint", "close",  "acknowledge", "frames", "submit", "list_jobs", "cancel", "acknowledge_job",
                               "list_sessions"};
const form::Names server_types{"welcome", "unsupported", "accepted", "refused", "state",   "jobs",         "job",       "job_ended",
                               "gap",     "layout",      "phase",    "applied", "flipped", "checkpointed", "recovered", "ended",
                               "sessions"};

/// Reads the alternative of this number.
template <class Message, std::size_t index = 0>
void read_alternative(std::size_t wanted, form::Reading& reading, Message& message) {
    if constexpr (index < std::variant_size_v<Message>) {
        if (wanted == index)
            describe(reading, message.template emplace<index>());
        else
            read_alternative<Message, index + 1>(wanted, reading, message);
    }
}

template <class Message>
Result<Message> read(std::string_view text, std::size_t most, const form::Names& types) {
    if (text.size() > most) return bad_input("is longer than " + std::to_string(most) + " bytes", "message");
    auto json = parse_json(text);
    if (!json) return std::move(json).error().in("message");
    if (!json->is_object()) return bad_input("must be an object", "message");
    JsonReader reader(*json, "");
    form::Reading reading(reader);
    const std::size_t type = reader.choice("type", types);
    WEAVE_CHECK_OK(reader.status());
    Message message;
    read_alternative(type, reading, message);
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    return message;
}

template <class Message>
std::string write(const Message& message, const form::Names& types) {
    Json json{{"type", types[message.index()]}};
    form::Writing writing(json);
    std::visit([&](const auto& alternative) { describe(writing, alternative); }, message);
    return canonical_json(json);
}

}  // namespace

std::string write_message(const ClientMessage& message) {
    return write(message, client_types);
}

std::string write_message(const ServerMessage& message) {
    return write(message, server_types);
}

Result<ClientMessage> read_client_message(std::string_view text) {
    return read<ClientMessage>(text, most_client_bytes, client_types);
}

Result<ServerMessage> read_server_message(std::string_view text) {
    return read<ServerMessage>(text, most_server_bytes, server_types);
}

std::optional<std::string> request_of(std::string_view text) {
    if (text.size() > most_client_bytes) return {};
    const auto json = parse_json(text);
    if (!json || !json->is_object()) return {};
    const auto request = json->find("request");
    if (request == json->end() || !request->is_string()) return {};
    auto id = request->get<std::string>();
    if (!form::is_request_id(id)) return {};
    return id;
}

}  // namespace weave::wire
