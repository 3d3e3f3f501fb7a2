#include "screen_file.hpp"
#include "submit_case.hpp"

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;

TEST_CASE("submit screens", "[.screens]") {
    const auto keep = [](QWidget& widget, const char* name) {
        QTest::qWait(500);
        widget.grab().save(screen_file(QString("%1.png").arg(name)));
    };
    Mill mill;
    {
        SubmitWindow stranger(mill.at("none"));
        keep(stranger.panel, "submit-1-stranger");
        stranger.sign_in(mill, "wrong");
        stranger.wait_for("sign_in_words", "wrong");
        keep(stranger.panel, "submit-2-wrong");
    }
    SubmitWindow window(mill.session_of("dora"));
    window.wait_signed_in();
    window.open_sample("tl013-wrong");
    window.panel.set_findings(1, 2, "The longest float on the back is 14 picks, the loom allows 12");
    window.type("new_design", "pocket");
    keep(window.panel, "submit-3-new");
    window.submit("The first pocket");
    window.wait_for("state", "Revision 1 is submitted");
    keep(window.panel, "submit-4-submitted");
    mill.signs("abel", {"request-changes", "pocket", "1"}, "The seam opens at pick 12");
    window.wait_for("state", "asks for changes");
    window.panel.set_findings(0, 0, {});
    window.open_sample("tl013-corrected");
    keep(window.panel, "submit-5-rejected");
}
