#include <filesystem>
#include <fstream>
#include <iterator>

#include "../assets/made_models.h"
#include "process.h"

// inspect and rig on models of one's own, and a run with what they lead to.
namespace skitter::test {
namespace {

namespace fs = std::filesystem;

struct RigCommand : AppTest {
  RigCommand() { fs::copy_file(SKITTER_ROOT "/assets/quadruped.glb", file("beast.glb")); }
};

TEST_F(RigCommand, InspectSaysWhatThereIs) {
  const Result result = skitter({"inspect", file("beast.glb"), "--json", file("beast.json")});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  for (const char* words :
       {"1 skins, 21 joints", "legs    4 found", "left_shoulder to left_forefoot", "skitter rig"}) {
    EXPECT_NE(result.out.find(words), std::string::npos) << words << "\n" << result.out;
  }
  const nlohmann::json report = json("beast.json");
  EXPECT_EQ(report.at("joints"), 21);
  EXPECT_EQ(report.at("legs").size(), 4u);
  EXPECT_EQ(report.at("legs")[0].at("joints").size(), 4u);
  EXPECT_EQ(report.at("isRig"), false);
}

TEST_F(RigCommand, InspectShowsMaterialsAndImages) {
  const Result result =
      skitter({"inspect", SKITTER_ROOT "/assets/piebald.glb", "--json", file("piebald.json")});
  ASSERT_EQ(result.code, 0) << result.err;
  for (const char* words :
       {"look    2 materials, 4 images",
        "\"coat\": metallic 1, roughness 1, base colour of images[0], metallic-roughness of images[1], "
        "normal of images[2], occlusion of images[1]\n",
        "\"mane\": metallic 0, roughness 0.9, base colour of images[3], cut out below 0.5, on both sides\n",
        "images[3]: 64 x 32 texels"}) {
    EXPECT_NE(result.out.find(words), std::string::npos) << words << "\n" << result.out;
  }
  const nlohmann::json report = json("piebald.json");
  EXPECT_EQ(report.at("materials").at(1).at("name"), "mane");
  EXPECT_EQ(report.at("materials").at(0).at("textures").at("normal").at("image"), 2);
  EXPECT_EQ(report.at("images").size(), 4u);
  EXPECT_EQ(report.at("images").at(0).at("width"), 128);
  EXPECT_NE(skitter({"inspect", file("beast.glb")}).out.find("look    colours at the vertices alone"),
            std::string::npos);
}

// A byte of the first image's rows is another, so that its checksum is wrong.
TEST_F(RigCommand, ABrokenImageIsAWarningAndAFlatColour) {
  std::ifstream from(SKITTER_ROOT "/assets/piebald.glb", std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(from), {}};
  bytes.at(bytes.find("IDAT") + 40) ^= 1;
  std::ofstream(file("piebald.glb"), std::ios::binary) << bytes;
  fs::copy_file(SKITTER_ROOT "/assets/piebald.rig.json", file("piebald.rig.json"));
  const std::string fault = "images[0]: corrupt PNG: ";
  const Result seen =
      skitter({"inspect", file("piebald.glb"), "--json", file("piebald.json"), "--out", file("piebald.png")});
  ASSERT_EQ(seen.code, 0) << seen.err;
  EXPECT_NE(seen.out.find(fault), std::string::npos) << seen.out;
  EXPECT_EQ(json("piebald.json").at("images").at(0).at("fault").get<std::string>().rfind(fault, 0), 0u);
  // The picture shows the sound image, and that it is missing.
  EXPECT_EQ(skitter({"inspect", SKITTER_ROOT "/assets/piebald.glb", "--out", file("sound.png")}).code, 0);
  const auto contents = [&](const char* name) {
    std::ifstream stream(file(name), std::ios::binary);
    return std::string{std::istreambuf_iterator<char>(stream), {}};
  };
  EXPECT_NE(contents("piebald.png"), contents("sound.png"));
  const Result drawn = skitter({"run", "--rig", file("piebald.glb"), "--agents", "3", "--frames", "2",
                                "--size", "64x36", "--quiet", "--out", file("herd.png")});
  EXPECT_EQ(drawn.code, 0) << drawn.err;
  EXPECT_EQ(drawn.err.rfind("warning: ", 0), 0u) << drawn.err;
  EXPECT_NE(drawn.err.find(fault), std::string::npos) << drawn.err;
  EXPECT_NE(drawn.err.find(": drawn as a flat colour\n"), std::string::npos) << drawn.err;
}

size_t timesIn(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST_F(RigCommand, WhatIsOddIsSaidWhereUsersLook) {
  writeMadeModels(file(""));
  Glb fox = readGlb(file("fox.glb"));
  fox.json["extensionsRequired"] = {"KHR_lights_punctual"};
  fox.json["animations"][0]["channels"].push_back({{"sampler", 0}, {"target", {{"path", "visible"}}}});
  fox.write(file("fox.glb"));
  const std::string
      lights = "requires extension \"KHR_lights_punctual\", which is not read: its lights are left out\n",
      clip = "animations[0] drives \"visible\", which is not played: channel left out\n";
  const std::string warnings =
      "warning: " + file("fox.glb") + ": " + lights + "warning: " + file("fox.glb") + ": " + clip;
  const Result seen = skitter({"inspect", file("fox.glb")});
  EXPECT_NE(seen.out.find("odd     " + lights), std::string::npos) << seen.out;
  EXPECT_EQ(seen.err, "");
  EXPECT_EQ(skitter({"rig", file("fox.glb")}).err, warnings);
  // The model is read twice, for the rig and for its clips.
  const Result run = skitter(
      {"run", "--rig", file("fox.glb"), "--controller", "clip", "--agents", "2", "--frames", "2", "--quiet"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(timesIn(run.err, warnings), 1u) << run.err;
  EXPECT_EQ(timesIn(run.err, lights), 1u) << run.err;

  // A run that fails says why there is nothing to play.
  for (nlohmann::json& each : fox.json["animations"])
    for (nlohmann::json& sampler : each["samplers"]) sampler["input"] = 9999;
  fox.write(file("fox.glb"));
  const Result none = skitter({"run", "--rig", file("fox.glb"), "--controller", "clip", "--frames", "2"});
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.err.find("animations[0].samplers[0].input is 9999"), std::string::npos) << none.err;
}

TEST_F(RigCommand, InspectSaysHowClipsAreBaked) {
  const Result result =
      skitter({"inspect", SKITTER_ROOT "/assets/spider.glb", "--json", file("spider.json")});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("\"walk\", 0.6 s, 28 channels: 95 frames of 44 joints"), std::string::npos)
      << result.out;
  EXPECT_NE(result.out.find("speed 1 m/s"), std::string::npos) << result.out;
  const nlohmann::json walk = json("spider.json").at("bakedClips").at(0);
  EXPECT_EQ(walk.at("name"), "walk");
  EXPECT_LE(walk.at("error"), 1e-4);
  EXPECT_NEAR(walk.at("speed"), 1, 1e-3);
}

TEST_F(RigCommand, InspectCountsModelsAndFindsLegs) {
  writeMadeModels(file(""));
  for (const MadeModel& model : madeModels()) {
    const Result result = skitter({"inspect", file(model.file)});
    EXPECT_EQ(result.code, 0) << model.file << result.err;
  }
  struct Arthropod {
    const char* file;
    size_t joints, clips, legs, jointsOfLeg;
    bool footJoint;
  };
  for (const Arthropod& expected :
       {Arthropod{"hexapod.glb", 37, 0, 6, 6, true}, Arthropod{"spider.gltf", 57, 1, 8, 5, false}}) {
    SCOPED_TRACE(expected.file);
    ASSERT_EQ(skitter({"inspect", file(expected.file), "--json", file("legs.json")}).code, 0);
    const nlohmann::json report = json("legs.json");
    EXPECT_EQ(report.at("joints"), expected.joints);
    EXPECT_EQ(report.at("clips").size(), expected.clips);
    ASSERT_EQ(report.at("legs").size(), expected.legs);
    for (const nlohmann::json& leg : report.at("legs")) {
      EXPECT_EQ(leg.at("joints").size(), expected.jointsOfLeg);
      EXPECT_EQ(leg.at("footJoint"), expected.footJoint);
    }
  }
}

TEST_F(RigCommand, InspectDrawsWithoutADevice) {
  const Environment nowhere = {{"VK_DRIVER_FILES", "/nowhere.json"}, {"VK_ICD_FILENAMES", "/nowhere.json"}};
  const Result result = runProgram(
      {SKITTER_BINARY, "inspect", file("beast.glb"), "--out", file("beast.png"), "--size", "200x150"},
      nowhere);
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_GT(fs::file_size(file("beast.png")), 2000u);
}

TEST_F(RigCommand, RigWritesASidecarThatWalks) {
  const Result result = skitter({"rig", file("beast.glb"), "--leg-length", "0.66"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(files(), (std::vector<std::string>{"beast.glb", "beast.rig.json"}));
  EXPECT_EQ(json("beast.rig.json").at("legs").size(), 4u);
  for (const char* rig : {"beast.glb", "beast.rig.json"}) {
    SCOPED_TRACE(rig);
    const Result run = skitter({"run", "--rig", file(rig), "--headless", "--agents", "5", "--frames", "60",
                                "--json", file("run.json")});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_LT(json("run.json").at("fidelity").at("reachErrorP99").get<double>(), 0.01);
    EXPECT_LT(json("run.json").at("fidelity").at("slip").get<double>(), 0.01);
  }
  EXPECT_EQ(
      skitter({"validate", "--rig", file("beast.glb"), "--agents", "8", "--frames", "20", "--quiet"}).code,
      0);
  write("scene.json", R"({"herds": [{"rig": "beast.rig.json", "agents": 2}]})");
  EXPECT_EQ(skitter({"run", file("scene.json"), "--headless", "--frames", "2"}).code, 0);
}

TEST_F(RigCommand, ForwardOverrulesTheProposal) {
  const auto proposed = [&](const char* forward) {
    EXPECT_EQ(skitter({"rig", file("beast.glb"), "--force", "--forward", forward}).code, 0) << forward;
    return json("beast.rig.json").at("forward");
  };
  EXPECT_EQ(proposed("-Z"), "-Z");
  EXPECT_EQ(proposed("0,0,-2"), "-Z");
  for (const char* faulty : {"ahead", "+W", "1,2", "0,0,0", "1,2,3,4"})
    expectRefusal(skitter({"rig", file("beast.glb"), "--force", "--forward", faulty}), 2, {"--forward"});
  expectRefusal(skitter({"rig", file("beast.glb"), "--force", "--forward", "+Y"}), 2,
                {"forward", "along up"});
}

TEST_F(RigCommand, ASidecarThatMayBeEditedIsNotOverwritten) {
  write("beast.rig.json", "{}");
  expectRefusal(skitter({"rig", file("beast.glb")}), 2, {"beast.rig.json", "--force"});
  EXPECT_TRUE(json("beast.rig.json").empty());
  // What is there is told for what it is.
  const Result result = skitter({"inspect", file("beast.glb")});
  EXPECT_NE(result.out.find("model is missing"), std::string::npos) << result.out;
  EXPECT_EQ(skitter({"rig", file("beast.glb"), "--force"}).code, 0);
  EXPECT_FALSE(json("beast.rig.json").empty());
}

TEST_F(RigCommand, SidecarElsewhereFindsItsModel) {
  fs::create_directory(file("rigs"));
  ASSERT_EQ(skitter({"rig", file("beast.glb"), "--out", file("rigs/b.rig.json")}).code, 0);
  EXPECT_EQ(json("rigs/b.rig.json").at("model"), "../beast.glb");
  EXPECT_EQ(
      skitter({"run", "--rig", file("rigs/b.rig.json"), "--headless", "--agents", "1", "--frames", "1"}).code,
      0);
}

TEST_F(RigCommand, Refusals) {
  write("text.glb", "no model");
  expectRefusal(skitter({"inspect", file("none.glb")}), 2, {"none.glb", "no such file"});
  expectRefusal(skitter({"inspect", file("text.glb")}), 2, {"text.glb", "not glTF"});
  expectRefusal(skitter({"rig", file("text.glb")}), 2, {"text.glb", "not glTF"});
  expectRefusal(skitter({"rig", file("beast.glb"), "--out", file("b.glb")}), 2, {"--out", ".rig.json"});
  expectRefusal(skitter({"rig", file("beast.glb"), "--leg-length", "0"}), 2, {"--leg-length"});
  expectRefusal(skitter({"inspect", file("beast.glb"), "--out", file("beast.jpg")}), 2, {"--out", ".png"});
  expectRefusal(skitter({"run", "--rig", file("beast.glb"), "--headless"}), 2, {"beast.glb", "skitter rig"});
  expectRefusal(skitter({"validate", "--rig", file("none.glb")}), 2, {"none.glb"});
  EXPECT_EQ(files(), (std::vector<std::string>{"beast.glb", "text.glb"}));
}

}  // namespace
}  // namespace skitter::test
