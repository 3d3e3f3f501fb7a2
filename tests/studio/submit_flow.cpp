#include "submit_case.hpp"

#include <studio/panels/scaled_picture.hpp>
#include <studio/panels/trouble_label.hpp>

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;

TEST_CASE("submit: a wrong password and a wrong fingerprint are refused, the right ones let in") {
    const Mill mill;
    const std::string file = mill.at("studio.session");
    SubmitWindow window(file);
    REQUIRE(window.wait([&] { return window.find<QPushButton>("sign_in").isVisible(); }));
    CHECK_FALSE(window.find<QPlainTextEdit>("note").isEnabled());

    const int person_was = window.place_of("person");
    const auto& greeting = window.find<QLabel>("greeting");
    window.sign_in(mill, "not the password");
    window.wait_for("sign_in_words", "name or password is wrong");
    CHECK(window.place_of("person") == person_was);
    CHECK(greeting.height() >= greeting.heightForWidth(greeting.width()));  // all of it is to be read
    CHECK(window.panel.focusWidget() == &window.find<QLineEdit>("password"));
    CHECK_FALSE(window.panel.desk().access().signed_in);
    CHECK(window.find<QLineEdit>("password").text().isEmpty());

    window.type("fingerprint", std::string(64, 'a'));
    window.type("password", Mill::password);
    window.click("sign_in");
    window.wait_for("sign_in_words", "shows another certificate");
    CHECK(window.place_of("person") == person_was);
    CHECK(greeting.height() >= greeting.heightForWidth(greeting.width()));
    const QString told = TroubleLabel::as_typed(window.text("sign_in_words"));
    CHECK(told.contains(QString::fromStdString(mill.fingerprint())));
    CHECK(told.contains(QString(64, 'a')));
    CHECK_FALSE(window.panel.desk().access().signed_in);
    CHECK_FALSE(std::filesystem::exists(file));

    CHECK(window.place_of("person") == person_was);

    window.type("mill", "localhost:1");
    window.type("password", Mill::password);
    window.click("sign_in");
    window.wait_for("sign_in_words", "localhost:1: cannot talk to the server");
    CHECK(window.text("gone").isEmpty());  // it is said once, where it is asked for
    CHECK(window.place_of("person") == person_was);

    window.type("mill", mill.origin());
    window.type("password", Mill::password);
    window.click("sign_in");
    window.wait_for("sign_in_words", "shows another certificate");
    const QString origin = QString::fromStdString(mill.origin());
    REQUIRE(origin.startsWith("https://"));
    window.type("mill", origin.mid(8).toStdString());  // as people say it
    const QString words = window.text("sign_in_words");
    window.find<QLineEdit>("fingerprint").setText(words.mid(words.indexOf("fingerprint is ") + 15, 67));  // copied, with the places where it may break
    window.type("password", Mill::password);
    window.click("sign_in");
    window.wait_signed_in();
    CHECK(window.find<QLineEdit>("mill").text() == origin);
    CHECK(window.text("who").startsWith("The dora"));
    CHECK_FALSE(window.find<QPushButton>("sign_in").isVisible());
    CHECK(read_file(file).value().find(Mill::password) == std::string::npos);
}

TEST_CASE("submit: who signed in by a command is signed in here too, and the other way round") {
    const Mill mill;
    SubmitWindow window(mill);
    QTest::mouseClick(&window.find<QPushButton>("sign_out"), Qt::LeftButton);
    REQUIRE(window.wait([&] { return !window.panel.desk().access().signed_in; }));
    window.type("password", Mill::password);  // mill, fingerprint and name stand there already
    QTest::keyClick(&window.find<QLineEdit>("password"), Qt::Key_Return);
    window.wait_signed_in();
    CHECK(mill.as("dora", {"me"}).at("person").at("name") == "dora");
}

TEST_CASE(
    "submit: a new design is saved and submitted, and another person's approval appears without a click") {
    const Mill mill;
    SubmitWindow window(mill.session_of("dora"));
    window.panel.suggest_name("Pocket, for Anna");
    window.wait_signed_in();
    CHECK(window.find<QLineEdit>("new_design").text() == "Pocket-for-Anna");
    window.type("new_design", "pocket");
    window.submit("The first pocket");
    window.wait_for("told", "submitted, waits for approval");
    window.wait_for("state", "Revision 1 is submitted");
    CHECK(window.talk().contains("Submitted"));
    CHECK(window.find<QPlainTextEdit>("note").toPlainText().isEmpty());
    CHECK(window.find<QLineEdit>("signing_password").text().isEmpty());
    window.wait_for("changes", "is what revision 1 holds");
    CHECK_FALSE(window.find<QPushButton>("submit").isEnabled());

    mill.signs("abel", {"approve", "pocket", "1"}, "Looked at face and back");
    window.wait_for("state", "Revision 1 is approved");
    CHECK(window.talk().contains("The abel"));
    CHECK(window.talk().contains("Looked at face and back"));
    REQUIRE(window.wait([&] { return window.find<QComboBox>("design").currentText() == "pocket — revision 1, approved"; }));
}

TEST_CASE("submit: a second revision shows what changed, and a rejection its reason") {
    const Mill mill;
    SubmitWindow window(mill);
    window.save("cloth", "A first try");
    window.wait_for("state", "Revision 1 is saved, not submitted");
    window.wait_for("changes", "is what revision 1 holds");

    window.open_sample("twill-2-2");
    window.wait_for("changes", "crossings differ");
    const auto& picture = window.find<ScaledPicture>("change_picture");
    CHECK(picture.isVisible());
    const double share = picture.heightForWidth(400) / picture.image().deviceIndependentSize().height();
    CHECK(share * 11 >= 9);                          // its numbers are 11 pixels high
    CHECK(picture.image().devicePixelRatio() == 2);  // and sharp at 200 %
    QTest::keyClick(&window.find<QWidget>("all_changes"), Qt::Key_Space);
    CHECK(window.find<QPlainTextEdit>("change_words").toPlainText().contains("revision 1"));

    window.submit("Twill in place of the pocket");
    window.wait_for("state", "Revision 2 is submitted");
    mill.signs("abel", {"request-changes", "cloth", "2"}, "The toe floats too far");
    window.wait_for("state", "The abel asks for changes: The toe floats too far");
    CHECK(window.text("state").contains("Revision 2 is rejected"));

    mill.as("abel", {"comment", "cloth", "2", "Here it is", "--pick", "3"});
    REQUIRE(window.wait([&] { return window.talk().contains("pick 3: Here it is"); }));
    window.type("comment", "I see it");
    window.click("send_comment");
    REQUIRE(window.wait([&] { return window.talk().contains("I see it"); }));
    CHECK(window.find<QLineEdit>("comment").text().isEmpty());
}

TEST_CASE("submit: a wrong signing password keeps what was saved, and the mill's words are shown") {
    const Mill mill;
    SubmitWindow window(mill);
    window.type("new_design", "cloth");
    window.write_note("Mine");
    window.type("signing_password", "not it");
    window.click("submit");
    window.wait_for("trouble", "the password is wrong");
    CHECK(window.find<QPlainTextEdit>("note").toPlainText() == "Mine");
    window.wait_for("state", "Revision 1 is saved, not submitted");
    REQUIRE(window.wait([&] { return window.find<QPushButton>("submit").text() == "Submit revision 1"; }));
    CHECK(window.panel.desk().access().signed_in);
    auto& password = window.find<QLineEdit>("signing_password");
    window.type("signing_password", "nor this");
    const int password_was = window.place_of("signing_password");
    QTest::keyClick(&password, Qt::Key_Return);
    REQUIRE(window.wait([&] { return window.text("trouble").isEmpty(); }));
    window.wait_for("trouble", "the password is wrong");
    CHECK(window.place_of("signing_password") == password_was);  // what is typed again lands where it did before
    CHECK(window.panel.focusWidget() == &password);
    window.submit("Now with the right one");
    window.wait_for("state", "Revision 1 is submitted");
    CHECK(window.text("trouble").isEmpty());
}

TEST_CASE("submit: a revision that cannot be compared keeps nobody from saving") {
    const Mill mill;
    SubmitWindow window(mill);
    window.save("cloth", "First");
    window.wait_for("changes", "is what revision 1 holds");
    window.write_note("Second");
    window.open_sample("twill-2-2");
    CHECK_FALSE(window.find<QPushButton>("save_revision").isEnabled());
    CHECK(window.text("hint").contains("is being compared"));
    Q_EMIT window.panel.desk().failed({MillTask::compare, "of a later version", false, false});
    CHECK(window.text("changes").contains("cannot be compared: of a later version"));
    CHECK(window.find<QPushButton>("save_revision").isEnabled());
}

TEST_CASE("submit: what was had from one mill is not taken for another's of the same name and number") {
    const Mill one, other;
    const std::string file = other.at("other.weave");
    REQUIRE(write_file(file, write_document(find_sample("twill-2-2")->make())));
    other.as("dora", {"design", "make", "cloth"});
    other.as("dora", {"save", file, "cloth", "--message", "Another cloth"});
    SubmitWindow window(one);
    window.save("cloth", "First");
    window.wait_for("changes", "is what revision 1 holds");
    QTest::mouseClick(&window.find<QPushButton>("sign_out"), Qt::LeftButton);
    REQUIRE(window.wait([&] { return !window.panel.desk().access().signed_in; }));
    window.sign_in(other);
    window.wait_signed_in();
    window.wait_for("changes", "crossings differ");
}

TEST_CASE("submit: a space in a new name is a hyphen, and an invitation has its way in") {
    const Mill mill;
    SubmitWindow window(mill);
    window.type("new_design", "My stencil");
    CHECK(window.find<QLineEdit>("new_design").text() == "My-stencil");
    CHECK(window.text("greeting").contains("loomlink user join"));
}

TEST_CASE("submit: somebody who saved first is not overwritten unseen") {
    const Mill mill;
    SubmitWindow window(mill);
    window.save("cloth", "Mine");
    window.wait_for("state", "Revision 1 is");
    const std::string other = mill.at("other.weave");
    REQUIRE(write_file(other, write_document(find_sample("twill-2-2")->make())));
    mill.as("dora", {"save", other, "cloth", "--message", "From elsewhere"});
    window.wait_for("changes", "crossings differ");  // with revision 2 now
    CHECK(window.find<QComboBox>("compare_with").currentText().contains("From elsewhere"));
}

TEST_CASE("submit: a mill that is gone is told in words, and all goes on when it is back") {
    Mill mill;
    SubmitWindow window(mill);
    window.type("new_design", "cloth");
    window.write_note("Half a note");
    mill.stop();
    window.find<QPushButton>("save_revision").click();
    window.wait_for("trouble", "The mill did not take it");
    window.wait_for("gone", "does not answer");
    CHECK(window.find<QPlainTextEdit>("note").toPlainText() == "Half a note");
    CHECK_FALSE(window.find<QPushButton>("save_revision").isEnabled());
    mill.start();
    REQUIRE(window.wait([&] { return window.text("gone").isEmpty(); }));
    window.click("save_revision");
    window.wait_for("state", "Revision 1 is saved");
}

TEST_CASE("submit: a session that has ended asks to sign in, and keeps what was written") {
    const Mill mill;
    SubmitWindow window(mill);
    window.type("new_design", "cloth");
    window.write_note("Still here");
    const auto elsewhere = mill.at("copy.session");
    std::filesystem::copy_file(mill.session_of("dora"), elsewhere);
    mill.as("copy", {"logout"});
    window.find<QPushButton>("save_revision").click();
    window.wait_for("sign_in_words", "has ended");
    CHECK(window.find<QPlainTextEdit>("note").toPlainText() == "Still here");
    window.type("password", Mill::password);
    window.click("sign_in");
    window.wait_signed_in();
    CHECK(window.find<QLineEdit>("new_design").text() == "cloth");
    window.click("save_revision");
    window.wait_for("state", "Revision 1 is saved");
}

TEST_CASE("submit: what is on its way can be given up") {
    Mill mill;
    SubmitWindow window(mill);
    window.panel.desk().watch(false);
    window.type("new_design", "cloth");
    window.write_note("Too early");
    // What is handed in waits for calls under way, which a mill that stands never answers: none is left. One of the answers may be
    // of a call from before.
    QSignalSpy told(&window.panel.desk(), &MillDesk::designs_told);
    window.panel.desk().list_designs();
    REQUIRE(window.wait([&] { return !told.isEmpty(); }));
    static_cast<void>(QTest::qWaitFor([&] { return told.count() > 1; }, 1000));
    mill.suspend();
    window.click("save_revision");
    REQUIRE(window.wait([&] { return window.find<QPushButton>("cancel_hand_in").isVisible(); }));
    window.wait_for("way", "The mill has it");
    window.click("cancel_hand_in");
    window.wait_for("trouble", "Cancelled");
    CHECK_FALSE(window.find<QPushButton>("cancel_hand_in").isVisible());
    CHECK(window.find<QPlainTextEdit>("note").toPlainText() == "Too early");
    mill.resume();
}

TEST_CASE("submit: what waits behind a call that the mill does not answer can be given up") {
    Mill mill;
    SubmitWindow window(mill);
    window.panel.desk().watch(false);
    window.type("new_design", "cloth");
    window.write_note("Too early");
    mill.suspend();
    window.panel.desk().list_designs();
    window.click("save_revision");
    REQUIRE(window.wait([&] { return window.find<QPushButton>("cancel_hand_in").isVisible(); }));
    window.click("cancel_hand_in");
    REQUIRE(window.wait([&] { return !window.panel.desk().is_busy(); }));
    CHECK(window.text("trouble").contains("Cancelled"));
    CHECK(window.find<QPlainTextEdit>("note").toPlainText() == "Too early");
    mill.resume();
    QSignalSpy told(&window.panel.desk(), &MillDesk::designs_told);
    window.panel.desk().list_designs();
    REQUIRE(window.wait([&] { return !told.isEmpty(); }));
    CHECK(told.last()[0].value<std::vector<wire::MillDesign>>().empty());  // nothing of it came to the mill
}

TEST_CASE("submit: another design of the same edition takes the place of the one before") {
    const Mill mill;
    SubmitWindow window(mill);
    window.save("cloth", "First");
    window.wait_for("changes", "is what revision 1 holds");
    window.panel.clear_design();
    CHECK_FALSE(window.find<QPushButton>("save_revision").isEnabled());
    --window.edition;
    window.open_sample("twill-2-2");
    window.wait_for("changes", "crossings differ");
}

TEST_CASE("submit: findings, evidence and a cloth that cannot be made are told") {
    const Mill mill;
    SubmitWindow window(mill);
    window.panel.set_findings(2, 1, "2 errors, 1 warning; 19 rules held");
    CHECK(window.text("findings_summary") == "Findings: 2 errors, 1 warning; 19 rules held");
    CHECK(window.text("submit_warning").contains("nobody can approve it"));
    CHECK(window.find<QLabel>("submit_warning").isVisible());
    window.panel.set_findings(0, 0, {});
    CHECK(window.text("submit_warning").isEmpty());

    CHECK(window.text("evidence").contains("none yet"));
    const int before = window.place_of("signing_password");
    window.panel.evidence().set_found(SimulationFound{"this computer", "standard",
                                                      QDateTime::currentDateTime(), true, true, window.edition});
    CHECK(window.text("evidence").contains("relaxed on this computer at standard, at rest"));
    CHECK_FALSE(window.find<QPushButton>("simulate").isVisible());
    CHECK(window.place_of("signing_password") == before);  // whoever is about to click there hits it
    CHECK(window.text("signed_evidence").contains("Nothing is signed"));
    window.open_sample("twill-2-2");
    CHECK(window.text("evidence").contains("has changed since"));

    window.type("new_design", "cloth");
    window.write_note("Why not");
    window.panel.set_design(window.design, nullptr, ++window.edition);
    CHECK_FALSE(window.find<QPushButton>("save_revision").isEnabled());
    CHECK(window.text("hint").contains("makes no cloth"));
}
