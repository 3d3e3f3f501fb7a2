#include <loomlink/service/answering.hpp>

#include <weave/core/sha256.hpp>
#include <weave/net/target.hpp>

#include <loomlink/service/gate.hpp>
#include <utility>

namespace weave::loomlink {

ApiHandler answering(std::function<Result<Json>(const ApiCall&)> work) {
    return [work = std::move(work)](const ApiCall& call) {
        const auto answer = work(call);
        return answer ? net::json_answer(200, *answer) : trouble_answer(answer.error());
    };
}

ApiHandler giving(std::function<Result<Content>(const ApiCall&)> work) {
    return [work = std::move(work)](const ApiCall& call) {
        auto content = work(call);
        if (!content) return trouble_answer(content.error());
        const std::string etag = net::etag_of(sha256_hex(content->bytes));
        net::Response response{304, {}, nullptr};
        if (!net::holds_already(call.request, etag))
            response = net::answer(200, content->media, net::make_bytes(std::move(content->bytes)));
        response.headers.set("ETag", etag);
        response.headers.set("Cache-Control", "private, no-cache");
        if (!content->file_name.empty())
            response.headers.set("Content-Disposition", disposition_of(content->file_name));
        return response;
    };
}

Ask ask_of(const ApiCall& call) {
    return {call.id(), call.text("password")};
}

CardTile tile_of(const ApiCall& call) {
    const auto number = [&](const char* name) { return call.query.value(name, std::size_t{1}); };
    return {number("x"), number("y"), number("w"), number("h"), number("scale")};
}

std::string disposition_of(const std::string& file_name) {
    const std::string encoded = net::percent_encoded(file_name);
    if (encoded == file_name) return "attachment; filename=\"" + file_name + '"';
    return "attachment; filename*=UTF-8''" + encoded;
}

}  // namespace weave::loomlink
