#include <loomlink/audit/bundle.hpp>

#include <loomlink/audit/bundle_layout.hpp>

namespace weave::loomlink {

namespace bundle {

namespace {

/// Hands out the lines of a file one by one.
class Lines {
  public:
    explicit Lines(std::string_view file) : m_rest(file) {}

    [[nodiscard]] bool at_end() const { return m_rest.empty(); }
    /// The next line without its line feed; whether it had one is told by ended().
    std::string_view next() {
        const std::string_view line = peek();
        m_ended = line.size() < m_rest.size();
        m_rest.remove_prefix(line.size() + (m_ended ? 1 : 0));
        ++m_number;
        return line;
    }
    [[nodiscard]] std::string_view peek() const { return m_rest.substr(0, m_rest.find('\n')); }
    [[nodiscard]] bool ended() const { return m_ended; }
    [[nodiscard]] std::size_t number() const { return m_number; }

  private:
    std::string_view m_rest;
    std::size_t m_number = 0;
    bool m_ended = true;
};

/// Takes the next line, which must be `text`; left where it stands if it is `skip_to`, which comes after.
void expect(Lines& lines, std::string_view text, Layout& layout, std::string_view skip_to = {}) {
    if (lines.peek() != text)
        layout.misfits.push_back({lines.number() + 1, "should be " + std::string(text)});
    if (skip_to.empty() || lines.peek() != skip_to) lines.next();
}

}  // namespace

Layout split(std::string_view file) {
    Layout layout;
    Lines lines(file);
    expect(lines, opening, layout);
    const std::string_view head = lines.next();
    if (head.starts_with(head_name))
        layout.head = head.substr(head_name.size());
    else
        layout.misfits.push_back({lines.number(), "should begin with " + std::string(head_name)});
    expect(lines, leaves_opening, layout);
    while (!lines.at_end() && lines.peek() != leaves_closing && lines.peek() != records_opening)
        layout.leaves.push_back(lines.next());
    expect(lines, leaves_closing, layout, records_opening);
    expect(lines, records_opening, layout);
    while (!lines.at_end() && lines.peek() != closing) layout.records.push_back(lines.next());
    expect(lines, closing, layout);
    if (!lines.ended()) layout.misfits.push_back({lines.number(), "should end with a line feed"});
    if (!lines.at_end()) layout.misfits.push_back({lines.number() + 1, "stands behind the end"});
    return layout;
}

}  // namespace bundle

std::string write_bundle(const AuditBundle& bundle) {
    std::string file;
    const auto line = [&](std::string_view text) { file.append(text).push_back('\n'); };
    line(bundle::opening);
    line(std::string(bundle::head_name) + signed_head_bytes(bundle.head) + ",");
    line(bundle::leaves_opening);
    for (std::size_t k = 0; k < bundle.leaves.size(); ++k)
        line("\"" + hash_hex(bundle.leaves[k]) + (k + 1 < bundle.leaves.size() ? "\"," : "\""));
    line(bundle::leaves_closing);
    line(bundle::records_opening);
    for (std::size_t k = 0; k < bundle.records.size(); ++k) {
        file.append(bundle.records[k]);
        line(k + 1 < bundle.records.size() ? "," : "");
    }
    line(bundle::closing);
    return file;
}

}  // namespace weave::loomlink
