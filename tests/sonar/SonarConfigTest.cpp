#include <gmock/gmock.h>

#include "components/framework/config/ConfigReader.hpp"
#include "components/framework/config/YamlText.hpp"
#include "components/sonar/beams/HeadScan.hpp"
#include "components/sonar/config/SonarConfig.hpp"
#include "components/sonar/tasks/AltimeterTask.hpp"
#include "components/sonar/tasks/ProfilerTask.hpp"
#include "components/sonar/tasks/SideScanTask.hpp"
#include "components/sonar/tasks/Sonar3dTask.hpp"

namespace insonify::sonar {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

template <class Config>
std::vector<std::string> findDiagnostics(const char* yaml) {
    framework::ConfigReader reader("sonar.yml");
    Config config;
    reader.read(YAML::Load(yaml), "", config);
    std::vector<std::string> texts;
    for (const auto& diagnostic : reader.diagnostics()) texts.push_back(diagnostic.path + ": " + diagnostic.message);
    return texts;
}

TEST(SonarConfigTest, EveryKeyOfTheContractIsAccepted) {
    EXPECT_THAT(findDiagnostics<SonarConfig>(R"(
        model: physical
        range: 75
        range_min: 0.5
        bin_count: 500
        bearings_deg: [-30, -10, 0, 5]
        beam_width_deg: 1.5
        beam_height_deg: 12
        beam_geometry: conical
        speed_of_sound: 1480
        water: {temperature_celsius: 12, salinity_psu: 35, depth: 8, ph: 8.1}
        absorption: {law: ainslie_mccolm, frequency_khz: 750}
        quality: {rows: 512, columns_per_beam: 4}
        range_rounding: exact
        device: software
        deposit: cpu
        draw_all: true)"),
                IsEmpty());
    EXPECT_THAT(findDiagnostics<SonarConfig>("{model: cerqueira2017, published: true, absorption: {db_per_m: 0.2}}"),
                IsEmpty());
    EXPECT_THAT(findDiagnostics<ScanningSonarConfig>(
                    "head: {left_deg: 60, right_deg: -60, step_deg: 0.9, speed_deg_per_s: 90}"),
                IsEmpty());
    EXPECT_THAT(findDiagnostics<ScanningSonarConfig>("{}"), IsEmpty());
}

TEST(SonarConfigTest, AProfilerAndAnAltimeterRejectInvalidThresholdsAndBeams) {
    EXPECT_THAT(
        findDiagnostics<ProfilerConfig>("{beam_count: 64, detection: {threshold_db: -40, gate_db: 6, floor_db: -140}}"),
        IsEmpty());
    EXPECT_THAT(findDiagnostics<ProfilerConfig>("detection: {threshold_db: 5}"),
                ElementsAre(AllOf(HasSubstr("detection.threshold_db"), HasSubstr("-300"), HasSubstr("0"))));
    EXPECT_THAT(findDiagnostics<ProfilerConfig>("detection: {gate_db: 0}"),
                ElementsAre(HasSubstr("detection.gate_db")));
    EXPECT_THAT(findDiagnostics<ProfilerConfig>("range_min: 60"), ElementsAre(HasSubstr("range_min: is 60 m")));
    EXPECT_THAT(findDiagnostics<AltimeterConfig>("{beam_width_deg: 120, beam_height_deg: 120, threshold_db: -30}"),
                IsEmpty());
    EXPECT_THAT(findDiagnostics<AltimeterConfig>("beam_width_deg: 121"),
                ElementsAre(HasSubstr("one beam may have 120")));
    EXPECT_THAT(findDiagnostics<AltimeterConfig>("threshold_db: 1"), ElementsAre(HasSubstr("threshold_db")));
    EXPECT_THAT(findDiagnostics<AltimeterConfig>("beam_count: 2"), ElementsAre(HasSubstr("beam_count")));
    EXPECT_THAT(findDiagnostics<AltimeterConfig>("detection: {gate_db: 3}"), ElementsAre(HasSubstr("detection")));
}

TEST(SonarConfigTest, ASideScanRejectsInvalidBeamsByItsOwnNames) {
    EXPECT_THAT(findDiagnostics<SideScanConfig>("{beam_width_deg: 1, beam_height_deg: 60, depression_deg: 20, "
                                                "quality: {rows: 4, columns_per_beam: 1024}}"),
                IsEmpty());
    EXPECT_THAT(findDiagnostics<SideScanConfig>("beam_height_deg: 130"),
                ElementsAre("beam_height_deg: is 130 deg; a side-scan's beam may have 120"));
    EXPECT_THAT(findDiagnostics<SideScanConfig>("beam_width_deg: 200"),
                ElementsAre(HasSubstr("beam_width_deg: is 200 deg")));
    EXPECT_THAT(findDiagnostics<SideScanConfig>("depression_deg: -5"), ElementsAre(HasSubstr("depression_deg")));
    EXPECT_THAT(findDiagnostics<SideScanConfig>("beam_geometry: conical"), ElementsAre(HasSubstr("beam_geometry")));
    EXPECT_THAT(findDiagnostics<SideScanConfig>("quality: {columns_per_beam: 5000}"),
                ElementsAre(HasSubstr("quality.columns_per_beam")));
    EXPECT_THAT(findDiagnostics<SideScanConfig>("beam_pattern: {transmit: {elevation: {width_deg: 50}}}"),
                ElementsAre(HasSubstr("receive.elevation")));
    EXPECT_THAT(findDiagnostics<SideScanConfig>("beam_count: 3"), ElementsAre(HasSubstr("beam_count")));
}

TEST(SonarConfigTest, A3dSonarRejectsInvalidGridsByItsOwnNames) {
    EXPECT_THAT(findDiagnostics<Sonar3dConfig>(
                    "{horizontal: {beam_count: 128, field_of_view_deg: 60}, vertical: {beam_count: 32, "
                    "field_of_view_deg: 20}, beam_height_deg: 0.6, quality: {rows: 2}}"),
                IsEmpty());
    EXPECT_THAT(findDiagnostics<Sonar3dConfig>("{}"), IsEmpty());
    EXPECT_THAT(findDiagnostics<Sonar3dConfig>("{horizontal: {beam_count: 1024}, vertical: {beam_count: 1024}}"),
                ElementsAre(HasSubstr("horizontal.beam_count: is 1024, with 1024 in the vertical 1048576 beams")));
    EXPECT_THAT(findDiagnostics<Sonar3dConfig>("vertical: {beam_count: 0}"),
                ElementsAre(HasSubstr("vertical.beam_count")));
    EXPECT_THAT(findDiagnostics<Sonar3dConfig>("horizontal: {field_of_view_deg: 270}"),
                ElementsAre(HasSubstr("horizontal.field_of_view_deg")));
    EXPECT_THAT(findDiagnostics<Sonar3dConfig>("beam_height_deg: 130"),
                ElementsAre(HasSubstr("beam_height_deg: is 130 deg")));
    EXPECT_THAT(findDiagnostics<Sonar3dConfig>("quality: {target_error: 0.01}"),
                ElementsAre(HasSubstr("quality: has a target")));
    EXPECT_THAT(findDiagnostics<Sonar3dConfig>("beam_geometry: conical"), ElementsAre(HasSubstr("beam_geometry")));
    EXPECT_THAT(findDiagnostics<Sonar3dConfig>("beam_pattern: {transmit: {azimuth: {width_deg: 90}}}"),
                ElementsAre(HasSubstr("beam_pattern.transmit.azimuth")));
    EXPECT_THAT(findDiagnostics<Sonar3dConfig>("detection: {threshold_db: 3}"),
                ElementsAre(HasSubstr("detection.threshold_db")));
}

TEST(SonarConfigTest, RejectsValuesOutOfBounds) {
    for (const char* yaml : {"range: 0",
                             "range: -5",
                             "range: .nan",
                             "range: .inf",
                             "range_min: -1",
                             "range_min: .nan",
                             "range_min: 60",
                             "quality: {target_error: 0}",
                             "quality: {target_error: 2}",
                             "quality: {budget_ms: 0}",
                             "beam_count: 0",
                             "beam_count: 5000",
                             "bin_count: 0",
                             "field_of_view_deg: 0",
                             "field_of_view_deg: -10",
                             "field_of_view_deg: 361",
                             "field_of_view_deg: .nan",
                             "beam_height_deg: 0",
                             "beam_height_deg: -10",
                             "beam_height_deg: .nan",
                             "beam_height_deg: 181",
                             "{visibility: gl, beam_height_deg: 160}",
                             "{visibility: cpu, model: cerqueira2017, published: true}",
                             "{visibility: cpu, deposit: gpu}",
                             "{beam_geometry: conical, bearings_deg: [0, 100], beam_width_deg: 2}",
                             "{visibility: cpu, beam_count: 4096, quality: {columns_per_beam: 4096}}",
                             "visibility: sonar",
                             "speed_of_sound: 0",
                             "speed_of_sound: -1500",
                             "speed_of_sound: 1.0e+9",
                             "speed_of_sound: .nan",
                             "speed_of_sound: .inf",
                             "water: {salinity_psu: -1}",
                             "quality: {rows: 0}",
                             "quality: {columns_per_beam: 4097}",
                             "quality: {max_samples: 0}",
                             "{bearings_deg: [0, 200], beam_width_deg: 1}",
                             "beam_count: 2.5",
                             "model: magic"})
        EXPECT_EQ(findDiagnostics<SonarConfig>(yaml).size(), 1u) << yaml;
}

TEST(SonarConfigTest, MultipathNeedsRaysAndHasBounds) {
    const auto fault = [](const char* yaml, const char* text) {
        EXPECT_THAT(findDiagnostics<SonarConfig>(yaml), ElementsAre(HasSubstr(text))) << yaml;
    };
    EXPECT_THAT(findDiagnostics<SonarConfig>("multipath: {surface: {wind_m_s: 0}, bounces: 2}"), IsEmpty());
    fault("multipath: {bounces: 3}", "multipath.bounces");
    fault("multipath: {bounces: -1}", "multipath.bounces");
    fault("multipath: {bounces: 1.5}", "multipath.bounces");
    fault("multipath: {surface: {wind_m_s: -1}}", "multipath.surface.wind_m_s");
    fault("multipath: {surface: {wind_m_s: .nan}}", "multipath.surface.wind_m_s");
    fault("multipath: {surface: 3}", "multipath.surface");
    fault("multipath: {}\nvisibility: gl", "visibility: is gl with multipath, which needs rays");
    fault("multipath: {}\ndeposit: gpu", "deposit: is gpu with multipath, which needs rays");
    fault("multipath: {}\nmodel: cerqueira2017", "multipath: is given with model: cerqueira2017");
    EXPECT_THAT(findDiagnostics<SonarConfig>("multipath: {bounces: 0}\nvisibility: gl\ndevice: software"), IsEmpty());
}

TEST(SonarConfigTest, WaterScattersByOneStrengthOrByLayers) {
    const auto diagnostic = [](const char* yaml, const char* text) {
        EXPECT_THAT(findDiagnostics<SonarConfig>(yaml), ElementsAre(HasSubstr(text))) << yaml;
    };
    EXPECT_THAT(findDiagnostics<SonarConfig>("volume: {strength_db: -70}"), IsEmpty());
    EXPECT_THAT(findDiagnostics<SonarConfig>(
                    "volume: [{top_m: 1, bottom_m: 5, strength_db: -70}, {top_m: 5, strength_db: -80}]"),
                IsEmpty());
    diagnostic("volume: {}", "volume: has no strength_db");
    diagnostic("volume: -70", "volume: is -70; must be a list");
    diagnostic("volume: {strength_db: 1}", "volume.strength_db: is 1");
    diagnostic("volume: [{strength_db: -70}, {top_m: 5, bottom_m: 2, strength_db: -70}]",
               "volume[1].bottom_m: is 2, not below top_m, 5");
    diagnostic("{model: cerqueira2017, volume: {strength_db: -70}}", "belongs to physical");
    std::string many = "volume: [";
    for (int i = 0; i < 17; ++i) many += "{strength_db: -70},";
    diagnostic((many + "]").c_str(), "volume: has 17 layers; may have 16");
}

TEST(SonarConfigTest, BeamsAndPulsesNeedTheirParameters) {
    const auto diagnostic = [](const char* yaml, const char* text) {
        EXPECT_THAT(findDiagnostics<SonarConfig>(yaml), ElementsAre(HasSubstr(text))) << yaml;
    };
    diagnostic("beam_pattern: {}", "beam_pattern: has no law");
    diagnostic("beam_pattern: {receive: {azimuth: {weighting: hann}}}", "receive.azimuth: has no width");
    diagnostic("beam_pattern: {receive: {azimuth: {aperture_m: 0.1}}}",
               "beam_pattern.receive.azimuth.aperture_m: is given without frequency_khz");
    diagnostic("{model: cerqueira2017, beam_pattern: {receive: {azimuth: {width_deg: 1}}}}", "it belongs to physical");
    diagnostic("pulse: {}", "pulse: has no length");
    diagnostic("pulse: {bandwidth_khz: 20, duration_us: 20}", "give one of the two");
    diagnostic("{model: cerqueira2017, pulse: {bandwidth_khz: 20}}", "it belongs to physical");
    EXPECT_THAT(
        findDiagnostics<SonarConfig>("{frequency_khz: 700, beam_pattern: {receive: {azimuth: {aperture_m: 0.1}}}}"),
        testing::IsEmpty());
}

TEST(SonarConfigTest, ReportsContradictoryValues) {
    struct Case {
        const char* yaml;
        const char* path;
        const char* words;
    };
    for (const Case& c :
         {Case{"{range: 10, range_min: 10}", "range_min: ", "must be below range, 10 m"},
          Case{"bearings_deg: [0, 1]", "beam_width_deg: ", "bearings_deg needs the width"},
          Case{"beam_width_deg: 3", "beam_width_deg: ", "256 beams of it cover 768 deg, may be 360"},
          Case{"{beam_width_deg: 90, beam_width_convention: total_fov, field_of_view_deg: 90}",
               "field_of_view_deg: ", "give one of the two"},
          Case{"{beam_width_deg: 1, field_of_view_deg: 90, model: cerqueira2017, published: true}",
               "beam_width_deg: ", "as wide as their spacing"},
          Case{"{bearings_deg: [0], beam_width_deg: 130}", "beam_width_deg: ", "one beam may have 120"},
          Case{"{beam_count: 4096, bin_count: 20000, range: 2000}",
               "bin_count: ", "81920000 bins in all; may be 16777216"},
          Case{"{beam_geometry: conical, field_of_view_deg: 200}", "beam_geometry: ", "at most 180 deg"},
          Case{"absorption: {frequency_khz: 700}", "absorption.frequency_khz: ", "needs the water block"},
          Case{"absorption: {}", "absorption: ", "give db_per_m, or frequency_khz"},
          Case{"{frequency_khz: 700, absorption: {}}", "absorption: ", "needs the water block"},
          Case{"absorption: {db_per_m: 1, frequency_khz: 700}", "absorption.db_per_m: ", "give one of the two"},
          Case{"quality: {rows: 64, target_error: 0.1}", "quality.target_error: ", "with another choice"},
          Case{"quality: {columns_per_beam: 4, budget_ms: 10}", "quality.budget_ms: ", "with another choice"},
          Case{"quality: {max_samples: 1000, budget_ms: 10}", "quality.max_samples: ", "with another choice"},
          Case{"quality: {rows: 64, max_samples: 1000}", "quality.max_samples: ", "with another choice"},
          Case{"published: true", "published: ", "only with model: cerqueira2017"},
          Case{"{model: cerqueira2017, published: true, bin_count: 1}", "bin_count: ", "at least 2"},
          Case{"{model: cerqueira2017, published: true, field_of_view_deg: 180}", "published: ", "less than 180"},
          Case{"{range: 1, bin_count: 1000}", "range: ",
               "1000 bins of whole microseconds reach 1.5 m, which may be at most 25 % more: give 1.5 m, lower"}})
        EXPECT_THAT(findDiagnostics<SonarConfig>(c.yaml), ElementsAre(AllOf(HasSubstr(c.path), HasSubstr(c.words))))
            << c.yaml;
}

TEST(SonarConfigTest, TheDefaultQualityIsAnErrorOfFivePerCentWithACapOfSamples) {
    SonarConfig config;
    EXPECT_EQ(config.targetError(), 0.05);
    EXPECT_EQ(config.maxSamples(), 400'000);
    config.quality.max_samples = 1000;
    EXPECT_EQ(config.targetError(), 0.05);
    EXPECT_EQ(config.maxSamples(), 1000);
    config.quality = {};
    config.quality.target_error = 0.1;
    EXPECT_FALSE(config.maxSamples()) << "a target alone";
    config.quality = {};
    config.quality.rows = 8;
    EXPECT_FALSE(config.choosesQuality() || config.maxSamples());
    EXPECT_EQ(config.rows(), 8) << "a user may give less than the chosen quality";
}

TEST(SonarConfigTest, OneWideBeamMayHaveThousandsOfColumns) {
    EXPECT_THAT(findDiagnostics<ScanningSonarConfig>("{beam_width_deg: 60, quality: {columns_per_beam: 4096}}"),
                IsEmpty());
}

TEST(SonarConfigTest, RejectsARangeThatBinsDoNotReachWithTheNextRangesThatFit) {
    const auto refused = findDiagnostics<SonarConfig>("{range: 2.97, bin_count: 675, speed_of_sound: 1466}");
    EXPECT_THAT(refused, ElementsAre(HasSubstr("range: is 2.97 m; 675 bins of whole microseconds reach 3.9582 m, which "
                                               "may be at most 25 % more: give 2.968 m or 3.958 m, lower bin_count")));
    for (const char* fits : {"{range: 2.968, bin_count: 675, speed_of_sound: 1466}",
                             "{range: 3.958, bin_count: 675, speed_of_sound: 1466}"})
        EXPECT_THAT(findDiagnostics<SonarConfig>(fits), IsEmpty());
}

TEST(SonarConfigTest, ExactRangesNeedNoWholeMicroseconds) {
    EXPECT_THAT(findDiagnostics<SonarConfig>("{range: 1, bin_count: 1000, range_rounding: exact}"), IsEmpty());
}

TEST(SonarConfigTest, RejectsImpossibleHeads) {
    struct Case {
        const char* yaml;
        const char* words;
    };
    for (const Case& c :
         {Case{"head: {left_deg: -60, right_deg: 60}", "must be above right_deg"},
          Case{"head: {left_deg: 30, right_deg: 30}", "must be above right_deg"},
          Case{"head: {left_deg: 300, right_deg: -300}", "at most 360 deg"},
          Case{"head: {left_deg: 60, right_deg: 60, continuous: false}", "must be above right_deg"},
          Case{"head: {left_deg: 1, right_deg: -1, step_deg: 3}", "the sector has 2 deg"},
          Case{"head: {step_deg: 0}", "0.001 to 360"}, Case{"head: {step_deg: 400}", "0.001 to 360"},
          Case{"head: {step_deg: -1}", "0.001 to 360"}, Case{"head: {step_deg: .nan}", "must be a finite number"},
          Case{"field_of_view_deg: 120", "is not a key here"}, Case{"beam_count: 2", "is not a key here"},
          Case{"{range: 10, range_min: 20}", "must be below range"}})
        EXPECT_THAT(findDiagnostics<ScanningSonarConfig>(c.yaml), ElementsAre(HasSubstr(c.words))) << c.yaml;
}

TEST(SonarConfigTest, TheWidthOfABeamIsOneBeamsOrByConventionTheWholeFans) {
    SonarConfig config;
    config.beam_count = 60;
    config.beam_width_deg = 1.5;
    EXPECT_DOUBLE_EQ(config.fan().coverageDeg(), 90);
    EXPECT_DOUBLE_EQ(config.fan().beamWidthDeg(), 1.5);
    config.beam_width_deg = 130;
    config.beam_width_convention = BeamWidthConvention::TotalFov;
    EXPECT_DOUBLE_EQ(config.fan().coverageDeg(), 130);
    EXPECT_DOUBLE_EQ(config.fan().beamWidthDeg(), 130.0 / 60);
    EXPECT_THAT(findDiagnostics<SonarConfig>("{beam_width_deg: 130, beam_width_convention: total_fov}"), IsEmpty());
}

TEST(SonarConfigTest, BeamsOfAFanMayBeWiderThanTheirSpacing) {
    for (const char* fov : {"130", "120"}) {  // also the default, if it is given
        const std::string yaml = "{beam_count: 512, field_of_view_deg: " + std::string(fov) + ", beam_width_deg: 1}";
        EXPECT_THAT(findDiagnostics<SonarConfig>(yaml.c_str()), IsEmpty()) << yaml;
    }
    SonarConfig config;
    config.beam_count = 512;
    config.field_of_view_deg = 130;
    config.beam_width_deg = 1;
    const SonarConfig fan = config.fan();
    EXPECT_EQ(fan.beams(), 512);
    EXPECT_DOUBLE_EQ(fan.beamWidthDeg(), 1);
    EXPECT_DOUBLE_EQ(fan.bearingDeg(0), -65 + 130.0 / 1024);
    EXPECT_DOUBLE_EQ(fan.bearingDeg(511), 65 - 130.0 / 1024);
    EXPECT_NEAR(fan.coverageDeg(), 130 - 130.0 / 512 + 1, 1e-9);
}

TEST(SonarConfigTest, BeamsOfAFanAreEvenAndCentredAndBeamsOfATableAreAsGiven) {
    SonarConfig config;
    config.beam_count = 4;
    config.field_of_view_deg = 120;
    EXPECT_DOUBLE_EQ(config.bearingDeg(0), -45);
    EXPECT_DOUBLE_EQ(config.bearingDeg(3), 45);
    EXPECT_DOUBLE_EQ(config.beamWidthDeg(), 30);
    config.bearings_deg = {-20, 5, 30};
    config.beam_width_deg = 2;
    EXPECT_EQ(config.beams(), 3);
    EXPECT_DOUBLE_EQ(config.bearingDeg(1), 5);
    EXPECT_DOUBLE_EQ(config.coverageDeg(), 52);
}

TEST(SonarConfigTest, AScanningSonarHasOneBeamOfThreeByThirtyFiveDegrees) {
    const SonarConfig beam = ScanningSonarConfig{}.beam();
    EXPECT_EQ(beam.beams(), 1);
    EXPECT_EQ(beam.bearingDeg(0), 0);
    EXPECT_EQ(beam.beamWidthDeg(), 3);
    EXPECT_EQ(beam.beam_height_deg, 35);
}

}  // namespace
}  // namespace insonify::sonar
