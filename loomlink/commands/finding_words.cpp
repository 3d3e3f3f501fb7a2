#include <loomlink/commands/finding_words.hpp>

#include <weave/core/text.hpp>

namespace weave::loomlink {

Json findings_json(const std::vector<AuditFinding>& findings) {
    Json list = Json::array();
    for (const AuditFinding& finding : findings)
        list.push_back({{"seq", finding.seq ? Json(*finding.seq) : Json(nullptr)},
                        {"place", finding.place},
                        {"cause", finding.cause}});
    return list;
}

std::string findings_words(const std::vector<AuditFinding>& findings) {
    std::string words;
    for (const AuditFinding& finding : findings) words += on_one_line(finding.text()) + "\n";
    return words;
}

}  // namespace weave::loomlink
