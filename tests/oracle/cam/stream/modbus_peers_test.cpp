// SPDX-License-Identifier: GPL-3.0-or-later
// Strangers at both ends: a PLC in Python that was written from the document alone, and mbpoll as a
// master of ours.
#include "tests/support/modbus_run.h"
#include "tests/support/run_program.h"

#include <netinet/in.h>
#include <sys/socket.h>

#include <csignal>
#include <fstream>

namespace {

using namespace std::chrono_literals;

/// A port that nobody has at the moment.
int free_port() {
    const int descriptor = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    ::bind(descriptor, any, size);
    ::getsockname(descriptor, any, &size);
    ::close(descriptor);
    return ntohs(address.sin_port);
}

/// A program that runs until the end of this.
struct Running {
    pid_t child = 0;

    explicit Running(std::vector<std::string> words) {
        std::vector<char*> argv;
        for (std::string& word : words) {
            argv.push_back(word.data());
        }
        argv.push_back(nullptr);
        ::posix_spawn(&child, argv.front(), nullptr, nullptr, argv.data(), environ);
    }

    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    Running(Running&&) = delete;
    Running& operator=(Running&&) = delete;

    ~Running() {
        ::kill(child, SIGKILL);
        int status = 0;
        ::waitpid(child, &status, 0);
    }
};

TEST(ModbusPeers, APlcWrittenFromTheDocumentTakesEveryLineOnce) {
    if (tests::run_program({"/usr/bin/python3", "-c", "import pymodbus.server"}).exit_code != 0) {
        GTEST_SKIP() << "python3-pymodbus is not installed";
    }
    constexpr std::size_t kLines = 1000;
    const tests::TempDir folder;
    const int number = free_port();
    const Running plc({"/usr/bin/python3",
                       std::string(HEW_SOURCE_DIR) + "/tests/support/mailbox_plc.py",
                       std::to_string(number), folder / "executed"});
    const std::string port = "tcp:127.0.0.1:" + std::to_string(number);
    bool up = false;
    for (int i = 0; i < 200 && !up; ++i) {
        std::this_thread::sleep_for(100ms);
        up = cam::transport::open_modbus(port, {}).has_value();
    }
    ASSERT_TRUE(up) << "the PLC does not come up";
    cam::protocol::JobLines job = tests::job_of(kLines, tests::mill_line);
    job.add("G4P0.01", 0, cam::protocol::LineKind::Drain);
    job.expect({99.9, 63, NAN, NAN, NAN, NAN});
    cam::protocol::MailboxOptions options;
    options.timeout = 2s;
    options.watchdog = 10s;
    options.meeting_wait = 20s;
    cam::protocol::Mailbox conversation(job, options);
    cam::transport::ModbusSettings settings;
    settings.timeout = 2000ms;
    cam::stream::Session session(conversation,
                                 [&] { return cam::transport::open_modbus(port, settings); }, {});
    const auto outcome = session.run();
    ASSERT_TRUE(outcome) << outcome.error().text();
    EXPECT_EQ(outcome->phase, cam::protocol::Phase::Finished)
        << outcome->code << ": " << outcome->text;
    std::ifstream executed(folder / "executed");
    std::string line;
    for (std::size_t i = 0; i < job.size(); ++i) {
        ASSERT_TRUE(std::getline(executed, line)) << i;
        ASSERT_EQ(line, job.text(i)) << i;
    }
    EXPECT_FALSE(std::getline(executed, line)) << line;
}

TEST(ModbusPeers, MbpollReadsTheVirtualPlcOverTcpAndRtu) {
    if (::access("/usr/bin/mbpoll", X_OK) != 0) {
        GTEST_SKIP() << "mbpoll is not installed";
    }
    for (const bool rtu : {false, true}) {
        const tests::TempDir folder;
        const std::string link = rtu ? (folder / "plc").string() : "";
        cam::sim::ModbusServer machine({}, {"127.0.0.1", rtu ? -1 : 0, link, 1, 0, {}});
        ASSERT_TRUE(machine.start());
        const std::string port = machine.port();
        std::vector<std::string> words = {"/usr/bin/mbpoll", "-m", rtu ? "rtu" : "tcp"};
        if (rtu) {
            words.insert(words.end(), {"-b", "115200", "-P", "none"});
        } else {
            words.insert(words.end(), {"-p", port.substr(port.rfind(':') + 1)});
        }
        words.insert(words.end(), {"-a", "1", "-0", "-r", "0", "-c", "8", "-1",
                                   rtu ? port : std::string("127.0.0.1")});
        const tests::Finished read = tests::run_program(words);
        EXPECT_EQ(read.exit_code, 0) << read.err << read.out;
        for (const char* wanted : {"[0]: \t18242", "[1]: \t1", "[2]: \t4", "[3]: \t121"}) {
            EXPECT_NE(read.out.find(wanted), std::string::npos) << wanted << "\n" << read.out;
        }
    }
}

}  // namespace
