// Programs that make the shards of a run on many machines: Dask, Ray, Slurm, Kubernetes. They make the same files as
// one machine.
#include <gmock/gmock.h>

#include <cerrno>
#include <map>

#include "tests/deployer/Wall.hpp"
#include "tests/support/Paths.hpp"
#include "tests/support/Python.hpp"

using namespace insonify::deployer;
using insonify::test::sourceFile;
using testing::HasSubstr;

namespace {

constexpr int shard_count = 6;

struct EngineTest : testing::Test {
    /** The run, without its shard; `out` is relative to the test's folder. */
    std::vector<std::string> runTo(const std::string& out) const {
        return {"run", folder_ / "wall.yml", "--out", folder_ / out, "--pings", "60"};
    }
    /** Returns the shards of a folder with all of their files; fails for other files. */
    static std::map<std::string, std::string> filesIn(const fs::path& out) {
        std::map<std::string, std::string> files;
        for (const auto& shard : fs::directory_iterator(out)) {
            EXPECT_TRUE(shard.path().filename().string().starts_with("shard_")) << shard.path() << " was left behind";
            for (const auto& file : fs::directory_iterator(shard))
                files[shard.path().filename() / file.path().filename()] = readFile(file.path());
        }
        return files;
    }
    /** Returns the files of one machine that makes one shard after the other. */
    std::map<std::string, std::string> byOne() const {
        for (int i = 0; i < shard_count; ++i) {
            std::vector<std::string> words = runTo("one");
            words.insert(words.end(), {"--shard", std::to_string(i) + "/" + std::to_string(shard_count)});
            EXPECT_EQ(callInsonify(folder_, words).code, 0);
        }
        return filesIn(folder_ / "one");
    }
    void expectAsByOne() const {
        const auto files = filesIn(folder_ / "shards"), one = byOne();
        EXPECT_EQ(files.size(), one.size());
        EXPECT_TRUE(files == one);
    }

    const WallFolder folder_;
};

/** A Python engine that makes shards on workers. */
struct Engine {
    const char *name, *module;
};

struct WorkersTest : EngineTest, testing::WithParamInterface<Engine> {
    void SetUp() override {
        if (!insonify::pythonHas(GetParam().module))
            GTEST_SKIP() << "SKIPPED: the Python package " << GetParam().module
                         << " is missing; scripts/setup installs it";
    }
    std::vector<std::string> byWorkers(const std::string& program, int workers) const {
        return byWorkers(program, workers, runTo("shards"));
    }
    std::vector<std::string> byWorkers(const std::string& program, int workers,
                                       const std::vector<std::string>& command) const {
        // Engines give up if a slow machine takes long to start them, and Ray leaves its session and a token behind.
        std::vector<std::string> words = {
            "env",
            "DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT=600s",
            "RAY_raylet_start_wait_time_s=600",
            "RAY_TMPDIR=" + folder_.path().string(),
            "RAY_AUTH_MODE=disabled",
            insonify::python(),
            sourceFile(std::string("scripts/research/dataset_") + GetParam().name + ".py"),
            "--shards",
            std::to_string(shard_count),
            "--workers",
            std::to_string(workers),
            "--",
            program};
        words.insert(words.end(), command.begin(), command.end());
        return words;
    }
    /** Runs the command, but the first process that gets shard 2 stops in the middle forever and reports its id. */
    fs::path stallingProgram() const {
        const std::string insonify = insonify::test::program("insonify"), first = folder_ / "first",
                          shards = folder_ / "shards";
        writeFile(folder_ / "insonify",
                  "#!/bin/sh\n"
                  "if [ \"$*\" != \"${*%--shard 2/6}\" ] && mkdir " +
                      first +
                      " 2> /dev/null; then\n"
                      "    " +
                      insonify +
                      " \"$@\" &\n"
                      "    until ls " +
                      shards + "/.shard_2_of_6.*/wall.0.log " + shards +
                      "/shard_2_of_6 2> /dev/null |\n"
                      "            grep -q .; do sleep 0.01; done\n"
                      "    kill -STOP $!\n"
                      "    echo $PPID $$ $! > " +
                      first + "/written && mv " + first + "/written " + first +
                      "/pids\n"
                      "    exec sleep 100000\n"
                      "fi\n"
                      "exec " +
                      insonify + " \"$@\"\n");
        fs::permissions(folder_ / "insonify", fs::perms::owner_all);
        return folder_ / "insonify";
    }
    /** Simulates the death of the machine of the stopped worker: its command, the worker, and the process that the
     *  worker waits for. On a slow machine the engine may have taken the worker for dead and ended it already. */
    void killStalled() const {
        std::istringstream pids(readFile(folder_ / "first/pids"));
        pid_t worker = 0, waiting = 0, command = 0;
        ASSERT_TRUE(pids >> worker >> waiting >> command);
        for (const pid_t pid : {command, worker}) EXPECT_TRUE(kill(pid, SIGKILL) == 0 || errno == ESRCH) << pid;
        kill(waiting, SIGKILL);  // Ray ends what a dead worker has started
    }
    static size_t getLines(const std::string& text, const std::string& ending) {
        size_t count = 0;
        for (size_t at = text.find(ending); at != text.npos; at = text.find(ending, at + 1)) ++count;
        return count;
    }
};

}  // namespace

TEST_P(WorkersTest, AWorkerThatDiesLosesAndDoublesNothing) {
    const Process engine(byWorkers(stallingProgram(), 2), folder_.path());
    const auto isAtIt = [&] {
        return fs::exists(folder_ / "first/pids") && getLines(readFile(folder_ / "stdout.txt"), "done\n") > 0;
    };
    for (int times = 0; times < 10 && !isAtIt(); ++times) insonify::test::becomesTrue(isAtIt);
    ASSERT_TRUE(isAtIt()) << readFile(folder_ / "stderr.txt");
    killStalled();
    const Outcome outcome = engine.wait();
    EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
    EXPECT_EQ(getLines(outcome.out, "done\n"), size_t{shard_count}) << outcome.out;
    for (int i = 0; i < shard_count; ++i)
        EXPECT_EQ(getLines(outcome.out, "shard " + std::to_string(i) + "/6: done\n"), 1u) << outcome.out;
    expectAsByOne();
}

TEST_P(WorkersTest, AFailingShardIsReportedAndFailsTheWholeRun) {
    fs::remove(folder_ / "wall.gltf");
    const Outcome outcome = Process(byWorkers(insonify::test::program("insonify"), 1), folder_.path()).wait();
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    EXPECT_EQ(getLines(outcome.out, ": exit code 2: "), size_t{shard_count}) << outcome.out;
    EXPECT_THAT(outcome.out, HasSubstr("wall.gltf"));
}

TEST_P(WorkersTest, ADataSetEqualsThatOfOneMachine) {
    writeFile(folder_ / "sweep.yml", "poses: {grid: {x: [0, 1, 2, 3], y: [0, 1]}}\npicture: {height: 64}\n");
    const auto dataSet = [&](const std::string& out) {
        return std::vector<std::string>{"dataset", folder_ / "wall.yml", "--sweep",  folder_ / "sweep.yml",
                                        "--out",   folder_ / out,        "--format", "yolo"};
    };
    ASSERT_EQ(callInsonify(folder_, dataSet("one")).code, 0);
    EXPECT_THAT(Process(byWorkers(insonify::test::program("insonify"), 2, dataSet("shards")), folder_.path()).wait(),
                succeeds());
    std::map<std::string, std::string> one, shards;
    for (const auto& file : fs::directory_iterator(folder_ / "one"))
        one[file.path().filename()] = readFile(file.path());
    for (const auto& file : fs::directory_iterator(folder_ / "shards"))
        shards[file.path().filename()] = readFile(file.path());
    EXPECT_TRUE(one.contains("manifest.json"));
    EXPECT_EQ(shards.size(), one.size());
    EXPECT_TRUE(shards == one);
}

INSTANTIATE_TEST_SUITE_P(All, WorkersTest, testing::Values(Engine{"dask", "distributed"}, Engine{"ray", "ray"}),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST_F(EngineTest, ASlurmArrayMakesAllShards) {
    const std::string script = sourceFile("deploy/slurm/shards.sbatch");
    const auto job = [&](const std::string& index, const std::string& first) {
        std::vector<std::string> words = {"env",
                                          "INSONIFY=" + insonify::test::program("insonify"),
                                          "SLURM_ARRAY_TASK_ID=" + index,
                                          "SLURM_ARRAY_TASK_MIN=" + first,
                                          "SLURM_ARRAY_TASK_MAX=5",
                                          "SLURM_ARRAY_TASK_STEP=1",
                                          "bash",
                                          script};
        const std::vector<std::string> run = runTo("shards");
        words.insert(words.end(), run.begin(), run.end());
        return Process(words, folder_.path()).wait();
    };
    for (int i = 0; i < shard_count; ++i) {
        EXPECT_THAT(job(std::to_string(i), "0"), succeeds());
    }
    expectAsByOne();
    EXPECT_THAT(job("1", "1"), isRefused(HasSubstr("the array must count from 0 by 1")));
    const Outcome alone = Process({"env", "-u", "SLURM_ARRAY_TASK_ID", "bash", script}, folder_.path()).wait();
    EXPECT_NE(alone.code, 0);
    EXPECT_THAT(alone.err, HasSubstr("SLURM_ARRAY_TASK_ID: is not set; submit with --array=0-N"));
}

TEST_F(EngineTest, AKubernetesJobIsWellFormedAndItsPodsMakeShards) {
    if (Process({"/usr/bin/python3", "-c", "import jsonschema, yaml"}, folder_.path()).wait().code != 0)
        GTEST_SKIP() << "SKIPPED: python3-jsonschema and python3-yaml are not installed; scripts/setup does that";
    const auto splitWords = [&](int index) {
        const Outcome outcome = Process({"/usr/bin/python3", sourceFile("tests/deployer/check_job.py"),
                                         sourceFile("deploy/kubernetes/shards.yml"), std::to_string(index)},
                                        folder_.path())
                                    .wait();
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return json::parse(outcome.out).get<std::vector<std::string>>();
    };
    fs::rename(folder_ / "wall.yml", folder_ / "mine.yml");
    for (const int index : {0, 15}) {
        std::vector<std::string> words = splitWords(index);
        *(std::ranges::find(words, "--pings") + 1) = "32";
        EXPECT_THAT(callInsonify(folder_, words), succeeds());
    }
    EXPECT_TRUE(fs::exists(folder_ / "mine/shard_00_of_16/manifest.json"));
    EXPECT_TRUE(fs::exists(folder_ / "mine/shard_15_of_16/wall.0.log"));
}
