#include <loomlink/commands/revision_place.hpp>

#include <weave/core/text.hpp>

#include <weave/wire/mill_designs.hpp>
#include <loomlink/commands/names.hpp>

namespace weave::loomlink {

std::string RevisionPlace::path(const std::string& below) const {
    const std::string path = wire::revision_path(design, revision());
    return below.empty() ? path : path + "/" + below;
}

std::string RevisionPlace::words() const {
    return on_one_line(design) + ", revision " + std::to_string(revision());
}

std::shared_ptr<RevisionPlace> add_revision_place(CLI::App* command, bool needs_number) {
    auto place = std::make_shared<RevisionPlace>();
    add_name(command, "DESIGN", place->design, "the design")->required();
    add_number(command, "REVISION", place->number, "the number of its revision")->required(needs_number);
    return place;
}

}  // namespace weave::loomlink
