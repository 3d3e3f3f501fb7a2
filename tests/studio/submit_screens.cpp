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
        stranger.panel.resize(300, 1150);
        stranger.type("fingerprint", std::string(64, 'a'));
        stranger.type("password", Mill::password);
        stranger.click("sign_in");
        stranger.wait_for("sign_in_words", "another certificate");
        keep(stranger.panel, "submit-2-other-certificate");
    }
    SubmitWindow window(mill.session_of("dora"));
    window.wait_signed_in();
    window.open_sample("tl013-wrong");
    window.panel.set_findings(1, 2, "1 error, 2 warnings; 19 rules held");
    window.type("new_design", "pocket");
    keep(window.panel, "submit-3-new");
    window.submit("The first pocket");
    window.wait_for("state", "Revision 1 is submitted");
    keep(window.panel, "submit-4-submitted");
    mill.signs("abel", {"request-changes", "pocket", "1"}, "The seam opens at pick 12");
    window.wait_for("state", "asks for changes");
    window.panel.set_findings(0, 0, "Nothing stands in the way of weaving this (22 rules held)");
    window.open_sample("tl013-corrected");
    keep(window.panel, "submit-5-rejected");
}
