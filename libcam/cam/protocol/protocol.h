// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/protocol/job_lines.h"

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Conversations with controllers as pure state machines: bytes and the time come in, bytes and
/// events go out. No port, no thread, no clock.
namespace cam::protocol {

/// Time since an arbitrary start; never goes back.
using Instant = std::chrono::nanoseconds;

/// Where a conversation stands.
enum class Phase {
    Closed,    ///< nothing is connected
    Meeting,   ///< finding out who is there
    Ready,     ///< known, and nothing has been sent of the job
    Checking,  ///< the controller reads the job in its check mode, without moving
    Running,
    Paused,    ///< by the operator or the machine
    Asking,    ///< a question waits for the operator
    Stopping,  ///< on the way to a standstill
    Stopped,   ///< by the operator; the job is over
    Finished,  ///< every line was answered and all motion is done
    Failed     ///< the job is over; the event Failed says why
};

/// What the operator wants.
enum class Wish {
    Pause,
    Resume,  ///< also the yes to a question
    Cancel,  ///< a controlled end: motion is halted, heaters and spindle go off
    Stop,    ///< at once, whatever it costs
    FeedUp,  ///< overrides, 10 % a step
    FeedDown,
    FeedReset,
    FirstChoice,  ///< of a question with choices; see choice()
    LastChoice = FirstChoice + 8
};

/// The wish to answer a question with its choice `index`, from 0 up to 8.
[[nodiscard]] constexpr Wish choice(int index) {
    return static_cast<Wish>(static_cast<int>(Wish::FirstChoice) + index);
}

/// Who is there.
struct Identity {
    std::string firmware;           ///< "Marlin 2.0.9.7 …", "Grbl 1.1h"
    std::string machine;            ///< as the firmware calls it; empty: it does not say
    std::string axes;               ///< letters in the order of reports, e.g. "XYZA"
    std::size_t receive_bytes = 0;  ///< of the controller's buffer; 0: unknown
    bool emergency_parser = false;  ///< a stop is seen ahead of waiting lines
    bool homed = true;              ///< false: the controller asks to be homed
    bool busy = false;              ///< it was moving when we came
    std::map<std::string, std::string> capabilities;  ///< Cap:X:1
    std::map<int, double> settings;                   ///< $0 …
    std::map<std::string, AxisValues> offsets_mm;     ///< G54 … G59, G28, G30, G92, TLO
};

struct Heater {
    std::string name;  ///< "T", "T1", "B"
    double celsius = 0;
    double target_celsius = 0;
};

/// What the machine last said of itself.
struct Status {
    std::string state;         ///< "Run", "Hold:0"; empty: the firmware does not say
    AxisValues position_mm{};  ///< work coordinates
    int axes = 0;              ///< of position_mm that are known
    std::vector<Heater> heaters;
    double feed_override = 1;
    long version = 0;  ///< grows with every change
};

/// How far the job is, in entries of its JobLines.
struct Progress {
    std::size_t acked = 0;  ///< answered for; every earlier one is too
    std::size_t sent = 0;
    std::size_t total = 0;
    long resent = 0;        ///< lines sent again
    long lost_answers = 0;  ///< answers that had to be asked for
    long strange = 0;       ///< answers that could not be read
};

struct Event {
    enum class Kind {
        Identified,  ///< identity() is complete
        Ready,       ///< `line`: entries that the machine has already, after a reconnection
        Checked,     ///< the check mode found no fault
        Paused,
        Resumed,
        Asked,   ///< `text`: the question
        Resent,  ///< `line` was asked for again
        Notice,
        Warning,
        Finished,
        Stopped,
        Failed  ///< `code` and `text` say why, `line` where
    };

    Kind kind = Kind::Notice;
    std::string text;
    std::string code;
    long line = 0;                       ///< entry of the job; see kind
    std::vector<std::string> choices{};  ///< of a question that is more than yes or no
};

/// What is to be done for the conversation. The caller takes it after every call.
struct Output {
    bool discard = false;  ///< what has not left yet is thrown away
    std::string urgent;    ///< goes out ahead of what has not left yet
    std::string bytes;
    std::vector<Event> events;

    [[nodiscard]] bool empty() const {
        return !discard && urgent.empty() && bytes.empty() && events.empty();
    }
};

/// How the board is met.
enum class Meeting {
    Fresh,  ///< a new job: line numbers begin anew
    Again   ///< the same job after the link was lost, or by a later process
};

/// Figures of the link; profiles give them.
struct LinkOptions {
    Instant banner_wait = std::chrono::seconds(3);  ///< for boards that reset when opened
    bool expects_banner = true;
    Instant silence = std::chrono::seconds(5);      ///< without a sign of life: ask
    Instant patience = std::chrono::minutes(10);    ///< without a sign of life: give up
    Instant poll = std::chrono::milliseconds(250);  ///< of the status (GRBL)
    std::size_t receive_bytes = 127;   ///< in flight at most, unless the machine says more
    int window = 1;                    ///< lines in flight at most (Marlin)
    double max_resend_fraction = 0.1;  ///< of the last 100 lines; more: pause
    bool precheck = true;              ///< run the job in check mode first (GRBL)
    bool offers_homing = true;         ///< ask whether a locked machine is to be homed (GRBL)
    double position_tolerance_mm = 0.01;
};

/// One conversation. Every call may add to the output; none blocks. Cost per line: O(1) and no
/// memory that grows with the job.
class Protocol {
  public:
    Protocol() = default;
    Protocol(const Protocol&) = delete;
    Protocol& operator=(const Protocol&) = delete;
    Protocol(Protocol&&) = delete;
    Protocol& operator=(Protocol&&) = delete;
    virtual ~Protocol() = default;

    /// The link is open: find out who is there. Ends in Phase::Ready or Failed.
    virtual void meet(Meeting meeting, Instant now) = 0;

    /// The link is gone; nothing more will be sent until meet().
    virtual void lose_link(Instant now) = 0;

    /// Streams the job from entry `first` on. Only in Phase::Ready. The job must outlive the
    /// conversation.
    virtual void run(std::size_t first, Instant now) = 0;

    virtual void receive(std::string_view bytes, Instant now) = 0;
    virtual void wish(Wish wish, Instant now) = 0;

    /// Entries from this one on are held back until they are allowed.
    virtual void allow(std::size_t entries, Instant now) = 0;

    /// Time has passed; to be called no later than deadline().
    virtual void tick(Instant now) = 0;
    [[nodiscard]] virtual std::optional<Instant> deadline() const = 0;

    [[nodiscard]] virtual Output take_output() = 0;
    [[nodiscard]] virtual Phase phase() const = 0;
    [[nodiscard]] virtual Progress progress() const = 0;
    [[nodiscard]] virtual const Identity& identity() const = 0;
    [[nodiscard]] virtual const Status& status() const = 0;
};

/// "running", "paused", …
[[nodiscard]] std::string_view phase_name(Phase phase);

/// Finished, Stopped or Failed.
[[nodiscard]] bool is_over(Phase phase);

}  // namespace cam::protocol
