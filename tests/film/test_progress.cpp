#include "host/report/json_file.h"
#include "host/report/progress.h"
#include "tests/film/film_fixtures.h"

#include <limits>

namespace reradiant {

TEST(Progress, LineShowsTheShareAndSurvivesNonsense) {
    EXPECT_EQ(progress_line(0.5, "half", 4), "[##--]  50 % half");
    EXPECT_EQ(progress_line(1.0, "", 4), "[####] 100 % ");
    EXPECT_EQ(progress_line(7.0, "", 4), "[####] 100 % ");
    EXPECT_EQ(progress_line(-1.0, "", 4), "[----]   0 % ");
    EXPECT_EQ(progress_line(std::numeric_limits<double>::quiet_NaN(), "", 4), "[----]   0 % ");
}

TEST(Progress, TimeLeftIsOfTheWorkThatThisRunDoes) {
    // A quarter in ten seconds: three quarters take thirty.
    EXPECT_NEAR(*seconds_left(10.0, 0.0, 0.25), 30.0, 1e-12);
    // The share that an earlier run did took no time here: from 0.5 to 0.75 in ten seconds, the
    // rest in ten more.
    EXPECT_NEAR(*seconds_left(10.0, 0.5, 0.75), 10.0, 1e-12);
    EXPECT_FALSE(seconds_left(1.0, 0.0, 0.5)) << "too early";
    EXPECT_FALSE(seconds_left(10.0, 0.5, 0.501)) << "too little";
    EXPECT_FALSE(seconds_left(10.0, 0.5, 0.5));
    EXPECT_FALSE(seconds_left(10.0, 0.0, 1.0)) << "done";
    EXPECT_FALSE(seconds_left(10.0, 0.0, std::numeric_limits<double>::quiet_NaN()));
}

TEST(Progress, DurationsAreInTheUnitThatOneSays) {
    EXPECT_EQ(duration_text(0.2), "1 s");
    EXPECT_EQ(duration_text(59.0), "59 s");
    EXPECT_EQ(duration_text(59.9), "1 min");
    EXPECT_EQ(duration_text(3569.0), "59 min");
    EXPECT_EQ(duration_text(5400.0), "1.5 h");
}

TEST(Progress, NothingIsDrawnWhereThereIsNoTerminal) {
    ::testing::internal::CaptureStderr(); // a file, as in a pipe or a log
    {
        ProgressBar bar(false);
        bar.update(0.5, "half");
    }
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(JsonFile, KeepsOrderAndTurnsNanIntoNull) {
    const TemporaryFolder folder;
    write_json(folder / "a.json",
               {{"z", 1}, {"a", std::numeric_limits<double>::quiet_NaN()}, {"text", "\xff"}});
    EXPECT_EQ(file_bytes(folder / "a.json"),
              "{\n  \"z\": 1,\n  \"a\": null,\n  \"text\": \"\xef\xbf\xbd\"\n}\n");
    write_json("", {{"nothing", "is written"}});
    error_message(1, [] { write_json("/dev/full", {{"a", 1}}); });
}

} // namespace reradiant
