// SPDX-License-Identifier: GPL-3.0-or-later
// Trajectories from files of many formats: what is read, and what is refused with file and line.
#include "exactvo/datasets/trajectory_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "exactvo/datasets/trajectory_survey.h"

namespace exactvo::test {
namespace {

using datasets::DataCode;
using datasets::DataError;
using datasets::TrajectoryFile;
using datasets::TrajectoryOptions;
using datasets::TrajectoryReader;
using datasets::TrajectoryRow;
using testing::ElementsAre;
using testing::HasSubstr;

class TextFile {
 public:
  explicit TextFile(const std::string& text) {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("exactvo-trajectories-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~TextFile() { std::filesystem::remove(path_); }
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

struct Content {
  TrajectoryFile file;
  std::vector<TrajectoryRow> rows;
};

Content content_of(const std::string& text, const TrajectoryOptions& options = {}) {
  const TextFile file(text);
  TrajectoryReader reader(file.path(), options);
  Content content;
  reader.read([&](const TrajectoryRow& row) { content.rows.push_back(row); });
  content.file = reader.file();
  return content;
}

/// The refusal of a text.
DataError refusal_of(const std::string& text, const TrajectoryOptions& options = {}) {
  try {
    content_of(text, options);
  } catch (const DataError& error) {
    return error;
  }
  return {DataCode::file_missing, "", "", "no refusal", ""};
}

void expect_row(const TrajectoryRow& row, std::size_t agent, double time, double x, double y, std::uint64_t line) {
  EXPECT_EQ(row.agent, agent);
  EXPECT_DOUBLE_EQ(row.time, time);
  EXPECT_DOUBLE_EQ(row.at.x, x);
  EXPECT_DOUBLE_EQ(row.at.y, y);
  EXPECT_EQ(row.line, line);
}

// --- Formats ---

TEST(TrajectoryFile, ReadsCsvWithColumnsInAnyOrder) {
  const Content c = content_of("# made by hand\ny,id,theta,t,x\n2,\"A, the first\",0.5,0,1\n\n4,B,1,0.5,3\r\n");
  EXPECT_EQ(c.file.format, "csv");
  EXPECT_THAT(c.file.agents, ElementsAre("A, the first", "B"));
  ASSERT_EQ(c.rows.size(), 2u);
  expect_row(c.rows[0], 0, 0.0, 1.0, 2.0, 3);
  expect_row(c.rows[1], 1, 0.5, 3.0, 4.0, 5);
  EXPECT_EQ(c.rows[0].heading, 0.5);
}

TEST(TrajectoryFile, IdsOfTablesWithAHeaderAreTexts) {
  const Content c = content_of("t,id,x,y\n0,007,1,1\n0,7,2,2\n0,7.0,3,3\n0,7e0,4,4\n1,007,1,1\n");
  EXPECT_THAT(c.file.agents, ElementsAre("007", "7", "7.0", "7e0"));
  ASSERT_EQ(c.rows.size(), 5u);
  EXPECT_EQ(c.rows[4].agent, 0u);
  const Content text = content_of("#framerate: 8\n#ID FR X Y\n007 0 1 1\n7 0 2 2\n");
  EXPECT_THAT(text.file.agents, ElementsAre("007", "7"));
  const Content numbers = content_of("0 7.0 1 1\n1 7.0000000e+00 1 1\n2 7 1 1\n");
  EXPECT_THAT(numbers.file.agents, ElementsAre("7"));
}

TEST(TrajectoryFile, ReadsTheTableOfARun) {
  const Content c =
      content_of("time_s,robot,x_m,y_m,vx_m_s,vy_m_s,status\n0,R1,1,2,0,0,best\n0.05,R1,1.5,2,0,0,best\n");
  EXPECT_THAT(c.file.agents, ElementsAre("R1"));
  expect_row(c.rows[1], 0, 0.05, 1.5, 2.0, 3);
  EXPECT_TRUE(std::isnan(c.rows[1].heading));
}

TEST(TrajectoryFile, ReadsPosesOfRosBags) {
  const std::string pose = "pose.pose.position.x,field.pose.pose.position.y,field.pose.pose.position.z";
  const std::string turn =
      "field.pose.pose.orientation.x,field.pose.pose.orientation.y,field.pose.pose.orientation.z,"
      "field.pose.pose.orientation.w";
  const Content echoed = content_of("%time,field.header.seq,field.header.frame_id,field." + pose + "," + turn +
                                    ",field.twist.twist.linear.x\n" +
                                    "1500000000,1,odom,1,2,0,0,0,0.6,0.8,5\n1600000000,2,odom,3,4,0,0,0,0,0,5\n");
  ASSERT_EQ(echoed.rows.size(), 2u);
  expect_row(echoed.rows[0], 0, 1.5, 1, 2, 2);
  expect_row(echoed.rows[1], 0, 1.6, 3, 4, 3);
  EXPECT_DOUBLE_EQ(echoed.rows[0].heading, 2.0 * std::atan2(0.6, 0.8));
  EXPECT_TRUE(std::isnan(echoed.rows[1].heading)) << "0 0 0 0 is no orientation";
  EXPECT_TRUE(std::isnan(echoed.rows[0].velocity.x)) << "a twist is in the axes of the robot";
  const Content plotted = content_of("__time,/odom/pose/pose/position/x,/odom/pose/pose/position/y\n7.5,1,2\n8,1,2\n");
  expect_row(plotted.rows.at(0), 0, 7.5, 1, 2, 2);
  const Content tilted = content_of("timestamp,tx,x,y,qx,qy,qz,qw\n0,0,1,2,0.5,0.5,0.5,0.5\n");
  EXPECT_DOUBLE_EQ(tilted.rows.at(0).heading, 2.0 * std::atan2(1.0, 1.0));
  const DataError two = refusal_of("__time,/a/position/x,/a/position/y,/b/position/x,/b/position/y\n7,1,2,3,4\n");
  EXPECT_EQ(two.code(), DataCode::format_unknown) << "two topics: which one is meant is not known";
}

TEST(TrajectoryFile, ReadsCurvesOfJson) {
  const Content c =
      content_of(R"({"id":"A","basis":"b-spline","degree":1,"start":1,"interval":0.5,"points":[[0,0],[1,0],[1,2]]})"
                 "\n"
                 R"({"id":7,"basis":"bezier","start":0,"end":2,"points":[[0,0],[1,2],[2,0]]})"
                 "\n"
                 R"({"id":7,"basis":"powers","start":3,"end":4,"points":[[5,5],[1,0]]})"
                 "\n");
  EXPECT_EQ(c.file.format, "curves");
  EXPECT_THAT(c.file.agents, ElementsAre("A", "7"));
  ASSERT_EQ(c.file.curves.size(), 2u);
  ASSERT_EQ(c.file.curves[0].size(), 2u) << "a piece for each interval";
  EXPECT_EQ(c.file.curves[0][1].start, 1.5);
  EXPECT_EQ(c.file.curves[0][1].end, 2.0);
  EXPECT_EQ(position_at(c.file.curves[0][1], 1.75), (geometry::Vec2{1.0, 1.0}));
  ASSERT_EQ(c.file.curves[1].size(), 2u);
  ASSERT_EQ(c.rows.size(), 33u + 17u + 17u);
  expect_row(c.rows[33 + 8], 1, 1.0, 1.0, 1.0, 2);
  expect_row(c.rows[33 + 17], 1, 3.0, 5.0, 5.0, 3);
}

TEST(TrajectoryFile, CurvesOfJsonThatCannotBeAreRefused) {
  const auto refused = [](const std::string& members) {
    const DataError error = refusal_of(R"({"id":"A","basis":"bezier",)" + members + "}\n");
    EXPECT_THAT(error.what(), HasSubstr("line 1")) << members;
    return error.code();
  };
  EXPECT_EQ(refused(R"("start":0,"end":0,"points":[[0,0]])"), DataCode::out_of_range);
  EXPECT_EQ(refused(R"("start":"nan","end":1,"points":[[0,0]])"), DataCode::out_of_range);
  EXPECT_EQ(refused(R"("start":0,"end":1,"points":[])"), DataCode::wrong_count);
  EXPECT_EQ(refused(R"("start":0,"end":1,"points":[[0,"inf"]])"), DataCode::out_of_range);
  EXPECT_EQ(refused(R"("start":0,"end":1)"), DataCode::key_missing);
  const std::string spline = R"({"id":"A","basis":"b-spline","start":0,"points":[[0,0],[1,1]],)";
  EXPECT_EQ(refusal_of(spline + R"("degree":2,"interval":1})").code(), DataCode::wrong_count);
  EXPECT_EQ(refusal_of(spline + R"("degree":1,"interval":0})").code(), DataCode::out_of_range);
  EXPECT_EQ(refusal_of(spline + R"("degree":11,"interval":1})").code(), DataCode::out_of_range);
  const std::string piece = R"({"id":"A","basis":"powers","start":0,"end":1,"points":[[0,0]]})";
  EXPECT_THAT(refusal_of(piece + "\n" + piece).what(), HasSubstr("line 2"));
  EXPECT_EQ(refusal_of(R"({"id":"A","basis":"spline","start":0,"end":1,"points":[[0,0]]})").code(),
            DataCode::not_an_option);
}

TEST(TrajectoryFile, ReadsJuPedSimAndPedPy) {
  const Content c = content_of(
      "#framerate: "
      "8.00\n#ID\tFR\tX\tY\tZ\tA\tB\tANGLE\tCOLOR\n7\t0\t1.5\t2\t0\t1\t1\t90\t255\n7\t4\t2\t2\t0\t1\t1\t0\t0\n");
  EXPECT_EQ(c.file.format, "jupedsim-txt");
  EXPECT_THAT(c.file.agents, ElementsAre("7"));
  expect_row(c.rows[1], 0, 0.5, 2.0, 2.0, 4);
  EXPECT_TRUE(std::isnan(c.rows[1].heading));
  const Content pedpy = content_of("# PeTrack\n# framerate: 25 fps\n# id frame x/cm y/cm z/m\n1 25 150 -200 1.7\n");
  EXPECT_EQ(pedpy.file.format, "jupedsim-txt");
  expect_row(pedpy.rows[0], 0, 1.0, 1.5, -2.0, 4);
}

TEST(TrajectoryFile, ReadsObsmatAndFourColumns) {
  const Content c = content_of(
      "  7.8000000e+02  1.0000000e+00  8.4568443e+00 0 3.5880664e+00 1.6 0 -0.2\n"
      "786 1 9.5 0 3.4 1 0 0\n",
      {"", 15.0, 1.0});
  EXPECT_EQ(c.file.format, "obsmat");
  EXPECT_THAT(c.file.agents, ElementsAre("1"));
  expect_row(c.rows[0], 0, 52.0, 8.4568443, 3.5880664, 1);
  EXPECT_TRUE(c.file.notes.empty());
  const Content four = content_of("0.0\t2.0\t1.5\t-3\n10.0\t2.0\t1.75\t-3\n");
  EXPECT_EQ(four.file.format, "frame-id-x-y");
  EXPECT_THAT(four.file.agents, ElementsAre("2"));
  expect_row(four.rows[1], 0, 10.0, 1.75, -3.0, 2);
  ASSERT_EQ(four.file.notes.size(), 1u);
  EXPECT_THAT(four.file.notes[0], HasSubstr("frame rate"));
}

TEST(TrajectoryFile, ReadsTrajNet) {
  const Content c = content_of(R"({"scene": {"id": 0, "p": 1, "s": 0, "e": 20, "fps": 2.5}}
{"track": {"f": 10, "p": 1, "x": 0.5, "y": -1}}
{"track": {"f": 20, "p": 1, "x": 1.5, "y": -1}}
{"track": {"f": 20, "p": 1, "x": 9, "y": 9, "prediction_number": 1, "scene_id": 0}}
)",
                               {"", 25.0, 1.0});
  EXPECT_EQ(c.file.format, "trajnet");
  ASSERT_EQ(c.rows.size(), 2u);
  expect_row(c.rows[1], 0, 0.8, 1.5, -1.0, 3);
  ASSERT_EQ(c.file.notes.size(), 1u);
}

TEST(TrajectoryFile, ReadsSumo) {
  const Content c = content_of(R"(<?xml version="1.0"?>
<!-- generated <timestep> -->
<fcd-export><timestep time="0.00">
  <vehicle id="a>b" x="1" y="2" angle="90.00" speed="3"/><person id='p'
    x="5" y="6"/></timestep>
<timestep time="1.5"/><timestep time="2"><vehicle id="a>b" x="4" y="2" angle="0"></vehicle></timestep>
</fcd-export>
)");
  EXPECT_EQ(c.file.format, "sumo-fcd");
  EXPECT_THAT(c.file.agents, ElementsAre("a>b", "p"));
  ASSERT_EQ(c.rows.size(), 3u);
  expect_row(c.rows[0], 0, 0.0, 1.0, 2.0, 4);
  EXPECT_DOUBLE_EQ(c.rows[0].heading, 0.0);
  expect_row(c.rows[1], 1, 0.0, 5.0, 6.0, 4);
  expect_row(c.rows[2], 0, 2.0, 4.0, 2.0, 6);
  EXPECT_NEAR(c.rows[2].heading, 1.5707963267948966, 1e-15);
}

TEST(TrajectoryFile, PlacesOfSumoInDegreesAreRefused) {
  const std::string file = R"(<fcd-export>
<timestep time="0"><vehicle id="car" x="120.991732" y="14.569786" angle="154" speed="14"/></timestep>
<timestep time="1"><vehicle id="car" x="120.991790" y="14.569671" angle="154" speed="14"/></timestep>
</fcd-export>
)";
  EXPECT_EQ(refusal_of(file, {"sumo-fcd", 0.0, 1.0}).code(), DataCode::projection);
  EXPECT_EQ(content_of(file, {"sumo-fcd", 0.0, 1e5}).rows.size(), 2u) << "with a scale, as the caller says";
}

TEST(TrajectoryFile, PlacesOfSumoInMetresAreReadHoweverFewRowsThereAre) {
  // A ring of 20 m at the origin, of which a row is kept each hour, and a car that comes back after two.
  std::string file = "<fcd-export>\n";
  for (int k = 0; k < 6; ++k)
    file += "<timestep time=\"" + std::to_string(3600 * k) + "\"><vehicle id=\"r\" x=\"" +
            std::to_string(20.0 * std::cos(k)) + "\" y=\"" + std::to_string(20.0 * std::sin(k)) +
            "\" speed=\"8\"/></timestep>\n";
  EXPECT_EQ(content_of(file + "</fcd-export>\n").rows.size(), 6u);
  const std::string back = R"(<fcd-export>
<timestep time="0"><vehicle id="car" x="10" y="0" speed="14"/></timestep>
<timestep time="1"><vehicle id="car" x="24" y="0" speed="14"/></timestep>
<timestep time="7200"><vehicle id="car" x="24" y="1" speed="14"/></timestep>
</fcd-export>
)";
  EXPECT_EQ(content_of(back).rows.size(), 3u);
  // Beyond 180 nothing is in degrees, whatever the speeds say.
  const std::string stuck = R"(<fcd-export>
<timestep time="0"><vehicle id="car" x="500" y="0" speed="14"/></timestep>
<timestep time="1"><vehicle id="car" x="500" y="0" speed="14"/></timestep>
</fcd-export>
)";
  EXPECT_EQ(content_of(stuck).rows.size(), 2u);
}

TEST(TrajectoryFile, QuotedFieldsMayHaveTheirSeparatorInside) {
  const Content c = content_of("\"t\";\"id\";\"x\";\"y\"\n0;\"a;b\";1;2\n1;c;3;\"4\"\n");
  EXPECT_EQ(c.file.format, "csv");
  EXPECT_THAT(c.file.agents, ElementsAre("a;b", "c"));
  ASSERT_EQ(c.rows.size(), 2u);
  expect_row(c.rows[1], 1, 1.0, 3.0, 4.0, 3);
}

TEST(TrajectoryFile, QuotedFieldsMayBeSeparatedByTabs) {
  const Content c = content_of("\"t\"\t\"note\"\t\"id\"\t\"x\"\t\"y\"\n0\t\t\"a\tb\"\t1\t2\n1\t\tc\t3\t\"4\"\n");
  EXPECT_EQ(c.file.format, "csv");
  EXPECT_THAT(c.file.agents, ElementsAre("a\tb", "c"));
  ASSERT_EQ(c.rows.size(), 2u);
  expect_row(c.rows[0], 0, 0.0, 1.0, 2.0, 2);
  expect_row(c.rows[1], 1, 1.0, 3.0, 4.0, 3);
}

/// As the text of JuPedSim is. The unit of velocities stays unknown.
TEST(TrajectoryFile, PlacesOfCsvInCentimetresAreReadAsSuch) {
  const Content c = content_of("t,id,x/cm,y/cm,vx,vy\n0,A,100,250,1,1\n1,A,200,250,1,1\n");
  ASSERT_EQ(c.rows.size(), 2u);
  expect_row(c.rows[1], 0, 1.0, 2.0, 2.5, 3);
  EXPECT_TRUE(std::isnan(c.rows[1].velocity.x));
}

TEST(TrajectoryFile, UnitsInNamesOfColumnsAreReadAndNoted) {
  struct Named {
    const char* header;
    const char* row;
    const char* note;
  };
  const Named all[] = {
      {"t_ms,id,x_mm,y_mm,vx_mm_s,vy_mm_s", "1500,A,100,250,1000,-500",
       R"note(read by their names: "t_ms" in ms, "x_mm" in mm, "y_mm" in mm, "vx_mm_s" in mm/s, "vy_mm_s" in mm/s)note"},
      {"Time [ms];id;X (mm);Y (mm);vx [cm/s];vy [cm/s]", "1500;A;100;250;100;-50",
       R"note(read by their names: "Time [ms]" in ms, "X (mm)" in mm, "Y (mm)" in mm, "vx [cm/s]" in cm/s, "vy [cm/s]" in cm/s)note"},
      {"t/us,id,pos_x_cm,pos_y_cm,v_x/m/s,v_y/m/s", "1500000,A,10,25,1,-0.5",
       R"note(read by their names: "t/us" in us, "pos_x_cm" in cm, "pos_y_cm" in cm)note"},
      {"timestamp_ns,id,/odom/position/x [cm],/odom/position/y [cm],vx (m/s),vy (m/s)", "1500000000,A,10,25,1,-0.5",
       R"note(read by their names: "timestamp_ns" in ns, "/odom/position/x [cm]" in cm, "/odom/position/y [cm]" in cm)note"}};
  for (const Named& named : all) {
    const Content c = content_of(std::string(named.header) + "\n" + named.row + "\n");
    ASSERT_EQ(c.rows.size(), 1u) << named.header;
    expect_row(c.rows[0], 0, 1.5, 0.1, 0.25, 2);
    EXPECT_EQ(c.rows[0].velocity, (geometry::Vec2{1.0, -0.5})) << named.header;
    EXPECT_THAT(c.file.notes, ElementsAre(named.note));
  }
  EXPECT_THAT(content_of("time_s,id,x_m,y [m],theta_rad\n1,A,2,3,4\n").file.notes, ElementsAre());
  EXPECT_EQ(content_of("t,id,x_mm,y_cm\n1,A,2000,300\n").rows[0].at, (geometry::Vec2{2.0, 3.0}));
  EXPECT_EQ(content_of("t,id,x_mm,y_mm\n0,A,70,7\n").rows[0].at, (geometry::Vec2{0.07, 0.007})) << "rounded once";
}

/// The scale is that of numbers whose unit nothing states.
TEST(TrajectoryFile, AScaleBesideAUnitIsRefused) {
  EXPECT_THAT(refusal_of("t,id,x_mm,y_mm\n0,A,1,2\n", {"", 0.0, 0.001}).what(),
              HasSubstr("found the scale 0.001 for \"x_mm\", expected no scale"));
  EXPECT_EQ(content_of("t_ms,id,x,y\n500,A,1,2\n", {"", 0.0, 2.0}).rows[0].at, (geometry::Vec2{2.0, 4.0}));
}

TEST(TrajectoryFile, VelocitiesWhoseUnitNothingTellsAreLeftOutWithANote) {
  for (const char* names : {"x_mm,y_mm,vx,vy", "x,y,vx_m_s,vy"}) {
    const Content c = content_of(std::string("t,id,") + names + "\n0,A,1,2,3,4\n");
    EXPECT_TRUE(std::isnan(c.rows.at(0).velocity.x)) << names;
    EXPECT_THAT(c.file.notes, Contains(HasSubstr("are left out, since their names do not state the unit"))) << names;
  }
}

TEST(TrajectoryFile, TimesBeyondAnyDateInSecondsAreNoted) {
  EXPECT_THAT(content_of("timestamp,id,x,y\n1700000000000,A,1,2\n").file.notes,
              ElementsAre(HasSubstr("times are read in seconds, and reach 1.7e+12 s")));
  EXPECT_THAT(content_of("timestamp,id,x,y\n1700000000,A,1,2\n").file.notes, ElementsAre());
}

/// As `numpy.savetxt` writes one.
TEST(TrajectoryFile, AHeaderMayStandInAComment) {
  for (const char* text : {"# t id x y\n0 7 1 2\n1 7 3 4\n", "# of a planner\n#t,id,x,y\n0,7,1,2\n# half\n1,7,3,4\n"}) {
    const Content c = content_of(text);
    EXPECT_EQ(c.file.format, "csv");
    EXPECT_THAT(c.file.agents, ElementsAre("7"));
    ASSERT_EQ(c.rows.size(), 2u);
    EXPECT_DOUBLE_EQ(c.rows[1].at.y, 4.0);
  }
}

TEST(TrajectoryFile, ReadsPlansOfPathFinding) {
  const Content c = content_of(
      "statistics:\n  cost: 3\nschedule:\n  agent0:\n    - x: 0\n      y: 1\n      t: 0\n    - x: 0\n      y: 2\n      "
      "t: 1\n");
  EXPECT_EQ(c.file.format, "mapf-yaml");
  EXPECT_TRUE(c.file.in_cells);
  expect_row(c.rows[1], 0, 1.0, 0.0, 2.0, 8);
  const Content paths = content_of("Agent 0: (1,2)->(1,3)->\nAgent 1: (4,5)->(4,5)->(4,6)\n");
  EXPECT_EQ(paths.file.format, "mapf-paths");
  ASSERT_EQ(paths.rows.size(), 6u);
  expect_row(paths.rows[1], 0, 1.0, 3.0, 1.0, 1);
  expect_row(paths.rows[4], 1, 2.0, 6.0, 4.0, 2);
}

/// As the planners have it: a plan in which an agent crosses the goal of one that has arrived is no solution.
TEST(TrajectoryFile, AgentsOfPlansRestAtTheirGoalsUntilThePlanEnds) {
  const Content paths = content_of("Agent 0: (0,0)->(0,1)\nAgent 1: (2,1)->(2,1)->(1,1)->(0,1)->\n");
  ASSERT_EQ(paths.rows.size(), 8u);
  expect_row(paths.rows[6], 0, 2.0, 1.0, 0.0, 1);
  expect_row(paths.rows[7], 0, 3.0, 1.0, 0.0, 1);
  EXPECT_THAT(paths.file.notes,
              ElementsAre("agents that have arrived rest at their goals until the plan ends, at 3 s"));
  const Content c = content_of(
      "schedule:\n  a:\n    - {x: 0, y: 1, t: 0}\n  b:\n    - {x: 5, y: 1, t: 1}\n    - {x: 5, y: 2, t: 2.5}\n");
  ASSERT_EQ(c.rows.size(), 6u);
  for (const auto& [row, time] : {std::pair{3, 1.0}, {4, 2.0}, {5, 2.5}}) expect_row(c.rows[row], 0, time, 0.0, 1.0, 3);
  EXPECT_THAT(content_of("Agent 0: (0,0)->(0,1)\nAgent 1: (2,1)->(2,2)\n").file.notes, ElementsAre());
  EXPECT_EQ(refusal_of("schedule:\n  a: [{x: 0, y: 1, t: 0}]\n  b: [{x: 5, y: 1, t: 1e20}]\n").code(), DataCode::size);
  const DataError much = refusal_of("schedule:\n  a: [{x: 0, y: 1, t: 0}]\n  b: [{x: 5, y: 1, t: 3000000}]\n");
  EXPECT_EQ(much.code(), DataCode::size);
  EXPECT_THAT(much.what(), HasSubstr("line 3"));
}

TEST(TrajectoryFile, ReadsVelocities) {
  const Content c = content_of("t,id,x,y,vx,vy\n0,A,1,2,3,-4\n", {"", 0.0, 0.5});
  EXPECT_EQ(c.rows[0].velocity, (geometry::Vec2{1.5, -2.0}));
  EXPECT_FALSE(is_finite(content_of("t,id,x,y,vx\n0,A,1,2,3\n").rows[0].velocity));
  const Content some = content_of("t,id,x,y,vx,vy\n0,A,1,2,3,-4\n1,A,1,2,,\n2,A,1,2, ,\n");
  EXPECT_TRUE(is_finite(some.rows[0].velocity));
  EXPECT_FALSE(is_finite(some.rows[1].velocity) || is_finite(some.rows[2].velocity));
  EXPECT_EQ(refusal_of("t,id,x,y,vx,vy\n0,A,1,2,3,\n").code(), DataCode::number);
}

TEST(TrajectoryFile, AFrameRateOfAFileMayBeginWithItsPoint) {
  EXPECT_DOUBLE_EQ(content_of("#framerate: .5\n#ID FR X Y\n1 1 0 1\n").rows[0].time, 2.0);
}

TEST(TrajectoryFile, AFrameRateWithoutFramesIsNoted) {
  const TrajectoryOptions options{"", 25.0};
  const auto note = ElementsAre(HasSubstr("--frame-rate has no effect"));
  EXPECT_THAT(content_of("t,id,x,y\n0,A,1,2\n", options).file.notes, note);
  EXPECT_THAT(content_of("Agent 0: (1,2)->\n", options).file.notes, note);
  EXPECT_THAT(content_of("frame,id,x,y\n0,A,1,2\n", options).file.notes, ElementsAre());
}

TEST(TrajectoryFile, ReadsPolynomialsAsCurvesAndSamplesOfThem) {
  const Content c = content_of("# duration,x^0,x^1,x^2,y^0,y^1,y^2,z^0\n2,0,4,1,1,0,0,7\n1,12,0,0,1,2,0,7\n");
  EXPECT_EQ(c.file.format, "polynomials");
  ASSERT_EQ(c.file.curves.size(), 1u);
  ASSERT_EQ(c.file.curves[0].size(), 2u);
  const geometry::CurvedMotion& second = c.file.curves[0][1];
  EXPECT_EQ(std::tie(second.start, second.end), std::make_tuple(2.0, 3.0));
  EXPECT_THAT(c.file.curves[0][0].points,
              ElementsAre(geometry::Vec2{0, 1}, geometry::Vec2{4, 0}, geometry::Vec2{1, 0}));
  EXPECT_EQ(c.rows.size(), 33u);
  expect_row(c.rows[16], 0, 2.0, 12.0, 1.0, 2);
  EXPECT_EQ(c.rows[8].velocity, (geometry::Vec2{6.0, 0.0}));
  EXPECT_EQ(refusal_of("duration,x^0,x^1,y^0,y^1\n1e60,0,1,0,0\n").code(), DataCode::out_of_range);
  EXPECT_EQ(refusal_of("duration,x^0,y^0\n-1,0,0\n").code(), DataCode::out_of_range);
  std::string header = "duration", row = "1";
  for (const char* axis : {"x", "y"})
    for (int k = 0; k <= 11; ++k) {
      header += std::string(",") + axis + "^" + std::to_string(k);
      row += ",0";
    }
  EXPECT_THAT(refusal_of(header + "\n" + row + "\n").what(), HasSubstr("powers up to 10"));
}

TEST(TrajectoryFile, ReadsRowsInMemory) {
  datasets::TrajectoryColumns columns{{"A", "B"}, {0, 1, 0}, {0, 0, 1}, {1, 2, 3}, {4, 5, 6}, {}, {7, 8, 9}, {0, 0, 0}};
  TrajectoryReader reader(columns, "rows", {"", 0.0, 2.0});
  for (int round = 0; round < 2; ++round) {
    std::vector<TrajectoryRow> rows;
    reader.read([&](const TrajectoryRow& row) { rows.push_back(row); });
    ASSERT_EQ(rows.size(), 3u);
    expect_row(rows[2], 0, 1.0, 6.0, 12.0, 3);
    EXPECT_EQ(rows[2].velocity, (geometry::Vec2{18.0, 0.0}));
  }
  EXPECT_THAT(reader.file().agents, ElementsAre("A", "B"));
  columns.time[2] = 0.0;
  TrajectoryReader twice(columns, "rows");
  EXPECT_THROW(twice.read([](const TrajectoryRow&) {}), DataError);
  columns.time.pop_back();
  EXPECT_THROW(TrajectoryReader(columns, "rows"), std::logic_error);
}

TEST(TrajectoryFile, OnlyPolynomialsAreReadTogether) {
  const TextFile one("duration,x^0,x^1,y^0,y^1\n1,0,1,0,0\n"), other("duration,x^0,y^0\n1,5,5\n"),
      table("t,id,x,y\n0,A,1,2\n");
  TrajectoryReader fleet(std::vector<std::string>{one.path(), other.path()});
  std::size_t rows = 0;
  fleet.read([&](const TrajectoryRow& row) { rows += row.agent + 1; });
  EXPECT_EQ(rows, 17u + 2u * 17u);
  EXPECT_EQ(fleet.file().curves.size(), 2u);
  EXPECT_THAT(fleet.file().file, HasSubstr("and 1 more"));
  EXPECT_THROW(TrajectoryReader(std::vector<std::string>{one.path(), table.path()}), DataError);
  EXPECT_EQ(datasets::recognised_trajectory_format(one.path()), "polynomials");
  EXPECT_EQ(datasets::recognised_trajectory_format(table.path()), "csv");
}

TEST(TrajectoryFile, ScalesAndReadsAgain) {
  const TextFile file("t,id,x,y\n0,A,100,200\n");
  TrajectoryReader reader(file.path(), {"", 0.0, 0.01});
  for (int round = 0; round < 2; ++round) {
    std::vector<TrajectoryRow> rows;
    reader.read([&](const TrajectoryRow& row) { rows.push_back(row); });
    ASSERT_EQ(rows.size(), 1u);
    expect_row(rows[0], 0, 0.0, 1.0, 2.0, 2);
    EXPECT_THAT(reader.file().agents, ElementsAre("A"));
  }
}

TEST(TrajectoryFile, RepeatedRowsAreLeftOutAndCounted) {
  const Content c = content_of("t,id,x,y\n0,A,1,2\n0,B,1,2\n0,A,1,2\n1,A,1,2\n");
  EXPECT_EQ(c.rows.size(), 3u);
  EXPECT_EQ(c.file.repeated, 1u);
}

TEST(TrajectoryFile, ASecondVelocityAtOneTimeIsRefusedWhereAsked) {
  const std::string rows = "t,id,x,y,vx,vy\n0,A,1,2,0,0\n0,A,1,2,1,0\n";
  EXPECT_EQ(content_of(rows).file.repeated, 1u);
  TrajectoryOptions options;
  options.one_velocity = true;
  const DataError error = refusal_of(rows, options);
  EXPECT_EQ(error.code(), DataCode::out_of_range);
  EXPECT_THAT(error.what(), HasSubstr("a second velocity at 0 s of agent A"));
  EXPECT_EQ(content_of("t,id,x,y,vx,vy\n0,A,1,2,1,0\n0,A,1,2,1,0\n", options).file.repeated, 1u);
}

TEST(TrajectoryFile, AnEmptyHeadingIsNone) {
  const Content c = content_of("t,id,x,y,theta\n0,A,1,2,\n1,A,1,2,0.5\n2,A,1,2, \n");
  ASSERT_EQ(c.rows.size(), 3u);
  EXPECT_TRUE(std::isnan(c.rows[0].heading));
  EXPECT_EQ(c.rows[1].heading, 0.5);
  EXPECT_TRUE(std::isnan(c.rows[2].heading));
}

// --- Refusals ---

TEST(TrajectoryFile, RefusalsNameTheLine) {
  struct Bad {
    const char* text;
    DataCode code;
    const char* words;
  };
  const Bad all[] = {
      {"t,id,x,y\n0,A,1,2\n1,A,nan,2\n", DataCode::not_finite, "line 3"},
      {"t,id,x,y\n0,A,1,2\ninf,A,1,2\n", DataCode::not_finite, "line 3"},
      {"t,id,x,y\n0,A,1,2\n1,A,one,2\n", DataCode::number, "line 3"},
      {"t,id,x,y\n0,A,1,2\n1,A,,2\n", DataCode::number, "line 3"},
      {"t,id,x,y\n0,A,1,2\n1,A,1\n", DataCode::wrong_count, "line 3"},
      {"t,id,x,y\n0,A,1,2\n1,,1,2\n", DataCode::format_syntax, "line 3"},
      {"t,id,x,y\n1,A,1,2\n0.5,A,1,2\n", DataCode::out_of_range, "no time before that of line 2"},
      {"t,id,x,y\n1,A,1,2\n1,A,1,3\n", DataCode::out_of_range, "line 2 has another"},
      {"t,id,x,y,theta\n1,A,1,2,0\n1,A,1,2,0.5\n", DataCode::out_of_range, "a second heading at 1 s of agent A"},
      {"t,id,x,y,theta\n0,A,1,2,0\n1e-155,A,1,2,0.5\n", DataCode::out_of_range,
       "another heading within 1e-155 s of agent A"},
      {"t,id,x,y,theta\n1,A,1,2,\n1,A,1,2,0.5\n", DataCode::out_of_range, "line 2 has another, or none"},
      {"t,id,x,y,theta\n1,A,1,2,north\n", DataCode::number, "line 2"},
      {"t,id,x,y\n1,A,1e40,2\n", DataCode::out_of_range, "2^100"},
      {"t,id,x,y\n", DataCode::format_syntax, "no row"},
      {"t,id,x,y\n0,\"A,1,2\n", DataCode::format_syntax, "quotation mark"},
      {"", DataCode::format_unknown, "an empty file"},
      {"hello\n", DataCode::format_unknown, "--format"},
      {"time [h];agent;X (ft);Y (ft)\n0;A;1;2\n", DataCode::format_unknown,
       "found \"time [h];agent;X (ft);Y (ft)\", expected a header with the columns t,id,x,y and, where there is one, "
       "theta: it has no t, no x, no y"},
      {"t,id,x_in,y_in\n0,A,1,2\n", DataCode::format_unknown, "it has no x, no y"},
      {"t_m,id,x,y\n0,A,1,2\n", DataCode::format_unknown, "it has no t"},
      {"t,id,x,x_mm,y\n0,A,1,2,3\n", DataCode::not_an_option, "line 1: found the columns \"x\" and \"x_mm\""},
      {"t_s,t_ms,id,x,y\n0,0,A,1,2\n", DataCode::not_an_option, "the columns \"t_s\" and \"t_ms\""},
      {"t,id,x_mm,y\n0,A,1,2\n", DataCode::not_an_option, "\"x_mm\" and \"y\", of which one states no unit"},
      {"t,id,x,y,x\n0,A,1,2,3\n", DataCode::json_duplicate_key, "column \"x\" a second time"},
      {"t,id,X,y,vx,vy,x\n0,A,1,2,3,4,5\n", DataCode::json_duplicate_key, "column \"x\" a second time"},
      {"# id frame x/cm x/m y/m\n#framerate: 8\n1 0 1 1 1\n", DataCode::not_an_option, "differ in the unit alone"},
      {"{\n\"name\": \"a\",\n\"robots\": []\n}\n", DataCode::format_unknown, "found a scenario, which is no run yet"},
      {"t,robot name,x,y\n1,A,1,2\n1,B,1,3\n", DataCode::out_of_range, "the table has no column of ids, such as id"},
      {"#framerate: x\n#ID FR X Y\n", DataCode::number, "line 1"},
      {"#framerate: 10\n#ID FR X Y\n1 0 1\n", DataCode::wrong_count, "line 3"},
      {"1 2 3 0 4 0 0 0\n2 2 3 0\n", DataCode::wrong_count, "line 2"},
      {"{\"track\": {\"f\": 1, \"p\": 1, \"x\": 1}}\n", DataCode::key_missing, "line 1"},
      {"{\"track\": {\"f\": 1, \"p\": 1, \"x\": 1\n", DataCode::json_syntax, "line 1"},
      {"<fcd-export><timestep time=\"0\">\n<vehicle id=\"a\" x=\"1\"/>", DataCode::key_missing, "line 2"},
      {"<fcd-export><timestep time=\"0\">\n<vehicle id=\"a\" x=\"1\" y=\"b\"/>", DataCode::number, "line 2"},
      {"<fcd-export>\n<vehicle id=\"a\" x=\"1\" y=\"1\"/>", DataCode::format_syntax, "line 2"},
      {"schedule:\n  a:\n    - x: 1\n      y: 1\n", DataCode::key_missing, "line 3"},
      {"schedule: [\n", DataCode::format_syntax, "YAML"},
      {"Agent 0: (1,2)->(1,x)->\n", DataCode::number, "line 1"},
      {"Agent 0: (1,2)->\nnothing\n", DataCode::format_syntax, "line 2"},
  };
  std::size_t judged = 0;
  for (const Bad& bad : all) {
    const DataError error = refusal_of(bad.text);
    EXPECT_EQ(error.code(), bad.code) << bad.text << error.what();
    EXPECT_THAT(error.what(), HasSubstr(bad.words)) << bad.text;
    ++judged;
  }
  EXPECT_EQ(judged, std::size(all));
  EXPECT_EQ(refusal_of("t,id,x,y\n0,A,1,2\n", {"sumo-fcs", 0.0, 1.0}).code(), DataCode::not_an_option);
}

TEST(TrajectoryFile, LinesAreBounded) {
  const std::string track = R"({"track": {"f": 1, "p": 1, "x": 1, "y": 1}})";
  const std::string texts[] = {track + "\n" + track + std::string(70000, ' ') + "\n",
                               "t,id,x,y\n0,A,1,2" + std::string(70000, ' ') + "\n",
                               "Agent 0: (1,2)->\nAgent 1: (1,2)->" + std::string(std::size_t{1} << 24, ' ') + "\n"};
  std::size_t judged = 0;
  for (const std::string& text : texts) {
    const DataError error = refusal_of(text);
    EXPECT_EQ(error.code(), DataCode::size) << error.what();
    EXPECT_EQ(error.place(), "line 2");
    ++judged;
  }
  EXPECT_EQ(judged, std::size(texts));
}

TEST(TrajectoryFile, XmlThatDoesNotEndIsRefused) {
  const std::string whole = R"(<?xml version="1.0"?><!-- a "comment --><fcd-export>
<timestep time="0"><vehicle id="a" x="1" y="2"/></timestep><timestep time='1'>
<vehicle id="a" x="2" y="2"></vehicle><![CDATA[ <"> ]]></timestep>
</fcd-export>)";
  EXPECT_EQ(content_of(whole).rows.size(), 2u);
  std::size_t cut = 0;
  const TrajectoryOptions sumo{"sumo-fcd", 0.0, 1.0};
  for (std::size_t size = 1; size < whole.size(); ++size, ++cut) {
    const DataError error = refusal_of(whole.substr(0, size), sumo);
    ASSERT_EQ(error.code(), DataCode::format_syntax) << size << error.what();
  }
  EXPECT_EQ(cut, whole.size() - 1);
  const auto with = [](const std::string& rows) {
    return "<fcd-export>\n<timestep time=\"0\">\n<vehicle id=\"a\" x=\"1\" y=\"2\"/>\n" + rows +
           "</timestep></fcd-export>\n";
  };
  struct Bad {
    std::string text;
    DataCode code;
    const char* words;
  };
  const Bad all[] = {
      {with("<vehicle id=\"b x=\"1\" y=\"1\"/>\n<vehicle id=\"c\" x=\"1\" y=\"2\"/>\n"), DataCode::format_syntax,
       "line 4"},
      {with("<vehicle id=\"b\" x=\"1\" y=\"1/>\n"), DataCode::format_syntax, "line 4"},
      {with("<vehicle id=\"b\" x=\"1\" y=\"1\"\n"), DataCode::format_syntax, "line 4"},
      {with("<!-- no end\n"), DataCode::format_syntax, "the end of the comment"},
      {with("</timestep>\n"), DataCode::format_syntax, "</fcd-export>"},
      {with("<vehicle id=\"b\" x=\"1\" y=\"1\">\n"), DataCode::format_syntax, "</vehicle>"},
      {with("") + "<vehicle id=\"b\" x=\"1\" y=\"1\"/>\n", DataCode::format_syntax, "line 5"},
      {with("</timestep><vehicle id=\"b\" x=\"1\" y=\"1\"/><timestep time=\"1\">\n"), DataCode::format_syntax,
       "a timestep round"},
      {with("<!DOCTYPE x [<!ENTITY a \"1\">]>"), DataCode::format_syntax, "entities"},
      {with("<vehicle id=\"" + std::string(70000, 'b') + "\" x=\"1\" y=\"1\"/>\n"), DataCode::size, "line 4"},
      {with("<vehicle " + std::string(70000, '\n') + "id=\"b\" x=\"1\" y=\"1\"/>\n"), DataCode::size, "line 4"},
      {with([] {
         std::string deep;
         for (int k = 0; k < 100; ++k) deep += "<a>";
         return deep;
       }()),
       DataCode::nesting, "line 4"},
  };
  std::size_t judged = 0;
  for (const Bad& bad : all) {
    const DataError error = refusal_of(bad.text, sumo);
    EXPECT_EQ(error.code(), bad.code) << bad.text.substr(0, 300) << error.what();
    EXPECT_THAT(error.what(), HasSubstr(bad.words)) << bad.text.substr(0, 300);
    ++judged;
  }
  EXPECT_EQ(judged, std::size(all));
  // A file without line ends is read as any other.
  std::string flat = "<fcd-export>";
  for (int k = 0; k < 5000; ++k)
    flat += "<timestep time=\"" + std::to_string(k) + "\"><vehicle id=\"a\" x=\"1\" y=\"2\"/></timestep>";
  EXPECT_EQ(content_of(flat + "</fcd-export>").rows.size(), 5000u);
}

TEST(TrajectoryFile, CutAndChangedFilesNeverEndInAnythingButAnAnswer) {
  const std::string texts[] = {
      "t,id,x,y,theta\n0,A,1,2,0\n1,A,2,2,0\n0.5,\"B\",3,4,0\n",
      "#framerate: 8.00\n#ID\tFR\tX\tY\n7\t0\t1.5\t2\n7\t4\t2\t2\n",
      "780 1 8.4 0 3.5 1.6 0 -0.2\n786 1 9.5 0 3.4 1 0 0\n",
      "{\"track\": {\"f\": 10, \"p\": 1, \"x\": 0.5, \"y\": -1}}\n",
      "<fcd-export><timestep time=\"0\"><vehicle id=\"a\" x=\"1\" y=\"2\" angle=\"9\"/></timestep></fcd-export>\n",
      "schedule:\n  a:\n    - x: 1\n      y: 1\n      t: 0\n",
      "Agent 0: (1,2)->(1,3)->\n",
      "duration,x^0,x^1,y^0,y^1\n1.5,0,1,0,0.25\n0.5,1.5,2,0.5,0\n",
  };
  std::size_t read = 0, refused = 0;
  const std::string bytes("\0\xff<>\"'{}[](),;:#\n -+e9", 22);
  for (const std::string& text : texts)
    for (std::size_t at = 0; at < text.size(); ++at) {
      std::vector<std::string> changed{text.substr(0, at)};
      std::string other = text;
      other[at] = bytes[at % bytes.size()];
      changed.push_back(other);
      for (const std::string& one : changed) {
        try {
          content_of(one);
          ++read;
        } catch (const DataError& error) {
          EXPECT_THAT(error.what(), HasSubstr("[E_"));
          ++refused;
        }
      }
    }
  EXPECT_GE(read, 80u);
  EXPECT_GE(refused, 100u);
}

// --- Survey ---

datasets::TrajectorySurvey survey_of(const std::string& text) {
  datasets::TrajectorySurvey survey;
  for (const TrajectoryRow& row : content_of(text).rows) survey.add(row);
  return survey;
}

TEST(TrajectorySurvey, KnowsSpeedsAccelerationsAndOrder) {
  const auto s = survey_of("t,id,x,y\n0,A,0,0\n0,B,5,5\n1,A,3,4\n2,A,3,4\n4,B,5,5\n3,A,3,4\n");
  EXPECT_FALSE(s.is_in_order());
  EXPECT_EQ(s.rows(), 6u);
  EXPECT_EQ(s.first(), 0.0);
  EXPECT_EQ(s.last(), 4.0);
  EXPECT_DOUBLE_EQ(s.agents()[0].speed.value, 5.0);
  EXPECT_EQ(s.agents()[0].speed.line, 4u);
  EXPECT_DOUBLE_EQ(s.agents()[0].acceleration.value, 5.0);
  EXPECT_EQ(s.agents()[1].speed.line, 0u);
  EXPECT_TRUE(std::isinf(s.jump_speed()));
}

TEST(TrajectorySurvey, BoundsForJumpsAndGapsAreRobust) {
  std::string text = "t,id,x,y\n";
  double x = 0.0;
  for (int k = 0; k < 100; ++k) {
    x += k == 50 ? 30.0 : 0.1;                                                          // 1 m/s, and once 300 m/s
    if (k != 70) text += std::to_string(0.1 * k) + ",A," + std::to_string(x) + ",0\n";  // one row is missing
  }
  const auto s = survey_of(text);
  EXPECT_GE(s.jump_speed(), 3.0);
  EXPECT_LE(s.jump_speed(), 3.0 * 1.1);
  EXPECT_GE(s.gap_of(0), 0.15);
  EXPECT_LE(s.gap_of(0), 0.15 * 1.1);
  EXPECT_NEAR(s.usual_interval(), 0.1, 0.01);
}

TEST(TrajectorySurvey, EachAgentHasItsOwnUsualInterval) {
  std::string text = "t,id,x,y\n";
  for (int k = 0; k < 40; ++k) {
    text += std::to_string(0.1 * k) + ",fast,0,0\n";
    if (k % 10 == 0) text += std::to_string(0.1 * k) + ",slow,0,0\n";
  }
  text += "5,slow,0,0\n6,slow,0,0\n";
  const auto s = survey_of(text);
  EXPECT_LE(s.gap_of(0), 0.17);
  EXPECT_GE(s.gap_of(1), 1.4);
}

TEST(TrajectorySurvey, NamesTheRowAtWhichAHeadingTurns) {
  const auto s = survey_of("t,id,x,y,theta\n0,A,0,0,1\n0,B,5,5,2\n1,A,3,4,1\n1,B,5,5,2.5\n");
  EXPECT_TRUE(s.has_headings());
  EXPECT_EQ(s.agents()[0].turns_at, 0u);
  EXPECT_EQ(s.agents()[0].heading, 1.0);
  EXPECT_EQ(s.agents()[1].turns_at, 5u);
}

}  // namespace
}  // namespace exactvo::test
