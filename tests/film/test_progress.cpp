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
