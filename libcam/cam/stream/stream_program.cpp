// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/stream/stream_program.h"

#include "cam/millproof/record.h"
#include "cam/stream/ask_place.h"
#include "cam/transport/modbus.h"
#include "cam/verify/proof_json.h"
#include "decomp/base/file.h"
#include "decomp/base/hash.h"
#include "decomp/base/number.h"

#include <algorithm>
#include <cmath>

namespace cam::stream {

using decomp::fail;
using decomp::Result;
using decomp::Status;

namespace {

constexpr std::size_t kPlannedByMarlin = 16;  ///< blocks, with the largest of its common set-ups
constexpr std::size_t kPlannedByGrbl = 18;
constexpr std::size_t kLongestForMarlin = 75;  ///< of 96, less number and checksum
constexpr std::size_t kLongestForGrbl = 79;

/// Whether a sidecar, of printing or of milling, holds for these bytes and this profile.
Status accept_proof(std::string_view sidecar, std::string_view program,
                    std::string_view profile_sha256) {
    if (millproof::is_mill_record(sidecar)) {
        const auto record = millproof::read_proof_json(sidecar);
        return record ? millproof::accept(*record, program, profile_sha256)
                      : Status(fail(record.error()));
    }
    const auto record = verify::read_proof_json(sidecar);
    return record ? verify::accept(*record, program, profile_sha256) : Status(fail(record.error()));
}

}  // namespace

ProgramStream::ProgramStream(Request request) : request_(std::move(request)) {
    if (request_.journal.empty()) {
        request_.journal = request_.program.string() + ".journal";
    }
}

ProgramStream::~ProgramStream() = default;

Result<std::unique_ptr<ProgramStream>> ProgramStream::open(Request request) {
    std::unique_ptr<ProgramStream> stream(new ProgramStream(std::move(request)));
    for (const auto step : {&ProgramStream::read_program, &ProgramStream::check_gate,
                            &ProgramStream::make_lines, &ProgramStream::sum_up}) {
        if (const Status done = (stream.get()->*step)(); !done) {
            return fail(done.error());
        }
    }
    return stream;
}

Status ProgramStream::read_program() {
    if (request_.link.line.protocol == "card") {
        return fail(
            "stream.card_only",
            "this machine takes its programs from a card: over its port a lost answer could "
            "not be told from a lost packet, and lines would be carried out twice",
            request_.machine, "copy the converted program (.x3g) beside the .gcode to its SD card");
    }
    auto program = decomp::read_file(request_.program);
    if (!program) {
        return fail(program.error());
    }
    program_ = std::move(*program);
    head_.program = request_.program.filename().string();
    head_.program_sha256 = decomp::sha256_hex(program_);
    head_.profile_sha256 = request_.foreign ? "" : request_.profile_sha256;
    head_.machine = request_.machine;
    head_.link = request_.link.name;
    head_.protocol = request_.link.line.protocol;
    head_.allowed = request_.allowed;
    head_.allowed.insert(head_.allowed.end(), request_.notes.begin(), request_.notes.end());
    head_.foreign = request_.foreign;
    return {};
}

Status ProgramStream::check_gate() {
    summary_ = "program " + head_.program + ", " + std::to_string(program_.size()) + " bytes\n";
    if (!request_.foreign) {
        const std::filesystem::path sidecar = request_.program.string() + ".proof.json";
        const auto text = decomp::read_file(sidecar);
        if (!text) {
            return fail("stream.no_proof", "the program has no proof", sidecar.string(),
                        "'hew verify' it; or --foreign, and only its bounds are looked at");
        }
        if (Status accepted = accept_proof(*text, program_, request_.profile_sha256); !accepted) {
            return accepted;
        }
        summary_ += "proof holds for these bytes and this profile\n";
    } else {
        summary_ +=
            "foreign program: only bounds, feeds and temperatures are looked at, not what it "
            "makes\n";
    }
    const std::vector<Objection> objections = examine_bounds(program_, request_.limits, {});
    if (Status judged = judge(objections, request_.allowed); !judged) {
        return judged;
    }
    for (const Objection& objection : objections) {
        summary_ += "allowed: " + objection.text + " [" + objection.code + "]\n";
    }
    return {};
}

WireOptions ProgramStream::wire_options() const {
    WireOptions options;
    options.flavour = request_.limits.flavour;
    options.longest_line = is_mill() ? kLongestForGrbl : kLongestForMarlin;
    options.parks = request_.link.mill.parks;
    options.park_z_mm = request_.link.mill.park_z_mm;
    options.spin_up_s = request_.link.mill.spin_up_s;
    return options;
}

Status ProgramStream::make_lines() {
    std::error_code ignored;
    const bool exists = std::filesystem::exists(request_.journal, ignored);
    if (request_.resume) {
        const auto contents = journal::read_journal(request_.journal);
        if (!contents) {
            return fail(contents.error());
        }
        const auto standing = read_standing(*contents);
        if (!standing) {
            return fail(standing.error());
        }
        return resume_lines(*standing);
    }
    if (exists && !request_.force) {
        const auto contents = journal::read_journal(request_.journal);
        const auto standing = contents ? read_standing(*contents) : fail(contents.error());
        const std::string how = standing ? standing->ending : "";
        const bool moved = !standing || standing->sent > 0;
        if (moved && !how.starts_with("finished")) {
            return fail("stream.journal_exists",
                        "this job was begun before and did not finish: " +
                            (standing ? std::to_string(standing->acked) + " of " +
                                            std::to_string(standing->head.entries) + " lines"
                                      : std::string("its journal cannot be read")),
                        request_.journal.string(), "--resume goes on, --force begins anew");
        }
    }
    auto job = prepare(program_, wire_options());
    if (!job) {
        return fail(job.error());
    }
    job_ = std::move(*job);
    return {};
}

/// The same wire lines as before, or those after a new beginning.
Status ProgramStream::resume_lines(const Standing& standing) {
    if (standing.head.program_sha256 != head_.program_sha256) {
        return fail("stream.journal_differs", "the journal is that of another program",
                    request_.journal.string(), "begin the job anew with --force");
    }
    if (standing.ending.starts_with("finished")) {
        return fail("stream.nothing_to_resume", "the job was finished", request_.journal.string(),
                    "begin it anew with --force");
    }
    const Flavour flavour = request_.limits.flavour;
    const ModalState before = replay(program_, flavour, standing.head.first_line);
    auto old =
        prepare_rest(program_, wire_options(), standing.head.first_line,
                     standing.head.first_line > 1 ? before : ModalState{}, standing.head.preamble);
    if (!old) {
        return fail(old.error());
    }
    summary_ += "the job stood at " + std::to_string(standing.acked) + " lines answered for, " +
                std::to_string(std::max(standing.sent, standing.acked)) + " sent, at most " +
                std::to_string(std::max(standing.allowed, standing.sent)) + " of " +
                std::to_string(old->lines.size()) + "\n";
    summary_ += standing.ended ? "it ended: " + standing.ending + "\n" : "it was cut off\n";
    same_board_ = (is_modbus() || !is_mill()) && !request_.after_reset && !request_.from_line;
    if (same_board_) {
        head_.first_line = standing.head.first_line;
        head_.preamble = standing.head.preamble;
        job_ = std::move(*old);
        summary_ +=
            "the board is asked for its last line; it must not have been reset since "
            "(if it was: home it, then --resume --after-reset)\n";
        return {};
    }
    return resume_after_reset(standing, *old);
}

/// A new beginning: at the line where the machine stands, or as far back as it can be.
Status ProgramStream::resume_after_reset(const Standing& standing, const WireJob& old) {
    const auto line_of = [&](std::size_t entries) {
        long line = standing.head.first_line - 1;
        for (std::size_t entry = 0; entry < std::min(entries, old.lines.size()); ++entry) {
            line = std::max(line, old.lines.source(entry));
        }
        return line;
    };
    long answered = line_of(standing.acked);
    // A mailbox tells which lines are done, not which were taken.
    std::size_t planned = is_modbus() ? 0 : is_mill() ? kPlannedByGrbl : kPlannedByMarlin;
    if (request_.from_line) {
        answered = *request_.from_line - 1;
        planned = 0;
    } else if (const auto stands =
                   line_where_it_stands(answered - static_cast<long>(planned),
                                        line_of(std::max(standing.allowed, standing.sent)));
               !stands) {
        return fail(stands.error());
    } else if (*stands) {
        answered = **stands - 1;
        planned = 0;
    }
    const auto plan = plan_resume(program_, wire_options(), answered, planned);
    if (!plan) {
        return fail(plan.error());
    }
    auto job =
        prepare_rest(program_, wire_options(), plan->first_line, plan->state, plan->preamble);
    if (!job) {
        return fail(job.error());
    }
    summary_ += plan->text;
    head_.first_line = plan->first_line;
    head_.preamble = plan->preamble;
    job_ = std::move(*job);
    return {};
}

/// A mill that kept its power stands on one of the lines that it was sent.
Result<std::optional<long>> ProgramStream::line_where_it_stands(long first, long last) {
    if (!is_mill() || is_modbus() || request_.after_reset || !request_.looks ||
        request_.link.line.reset_on_open) {
        return std::optional<long>{};
    }
    const auto place = ask_place(opener(), link_options());
    if (!place) {
        return fail(place.error());
    }
    if (!*place) {
        summary_ += "the machine does not tell where it stands\n";
        return std::optional<long>{};
    }
    const auto line = line_through(program_, request_.limits.flavour, first, last, **place);
    summary_ += "the machine stands at";
    for (std::size_t axis = 0; axis < 3; ++axis) {
        summary_ += std::string(" ") + "XYZ"[axis] + decomp::fixed((*place)->at(axis), 3);
    }
    summary_ += line ? ", on the way of line " + std::to_string(*line) + "\n"
                     : ", on none of the lines that it can have got\n";
    return line;
}

Status ProgramStream::sum_up() {
    head_.entries = job_.lines.size();
    summary_ += std::to_string(job_.lines.size()) + " lines to send, about " +
                std::to_string(static_cast<long>(job_.total_seconds / 60)) + " min of motion\n";
    if (is_modbus() && transport::is_public_address(request_.port)) {
        summary_ += "WARNING: " + request_.port +
                    " lies outside private networks; Modbus asks nobody for a name or password\n";
    }
    return {};
}

Status ProgramStream::admit(const protocol::Identity& identity) const {
    std::vector<Objection> objections =
        examine_machine(identity, {request_.link.identity.firmware, request_.link.identity.machine,
                                   request_.limits.axes, is_mill()});
    if (is_mill()) {
        Limits limits = request_.limits;
        limits.axes = std::min(limits.axes, static_cast<int>(identity.axes.size()));
        const std::vector<Objection> bounds = examine_bounds(program_, limits, identity.offsets_mm);
        objections.insert(objections.end(), bounds.begin(), bounds.end());
    }
    return judge(objections, request_.allowed);
}

void ProgramStream::make_session(const std::function<void(const Notice&)>& tell) {
    Session::Options options;
    options.meeting = same_board_ ? protocol::Meeting::Again : protocol::Meeting::Fresh;
    options.log = log_.get();
    options.admit = [this](const protocol::Identity& identity) { return admit(identity); };
    options.tell = tell;
    auto session = std::make_unique<Session>(*conversation_, opener(), options);
    const std::scoped_lock lock(mutex_);
    session_ = std::move(session);
    for (const protocol::Wish wish : early_) {
        session_->post(wish);
    }
}

/// The session must be there: it is woken when the disk has what it waits for.
Status ProgramStream::open_journal() {
    journal::Writer::Options options;
    options.on_synced = [session = session_.get()] { session->wake(); };
    std::error_code ignored;
    Result<std::unique_ptr<journal::Writer>> writer = [&] {
        if (!request_.resume) {
            std::filesystem::remove(request_.journal, ignored);
            return journal::Writer::create(request_.journal, options);
        }
        const auto contents = journal::read_journal(request_.journal);
        return journal::Writer::append(request_.journal, contents.value_or(journal::Contents{}),
                                       options);
    }();
    if (!writer) {
        return fail(writer.error());
    }
    journal_ = std::move(*writer);
    journal_->add(same_board_ ? "continue" : begin_record(head_), journal::Writer::Urgency::Urgent);
    session_->keep(*journal_);
    return {};
}

Result<Outcome> ProgramStream::run(const std::function<void(const Notice&)>& tell) {
    // The journal's thread wakes the session: it must have ended before that is gone.
    struct Ending {
        ProgramStream& stream;

        ~Ending() { stream.journal_.reset(); }
    } ending{*this};

    if (!request_.log.empty()) {
        auto log = RawLog::open(request_.log);
        if (!log) {
            return fail(log.error());
        }
        log_ = std::move(*log);
    }
    if (const Status made = make_conversation(); !made) {
        return fail(made.error());
    }
    make_session(tell);
    if (const Status opened = open_journal(); !opened) {
        return fail(opened.error());
    }
    return session_->run();
}

void ProgramStream::post(protocol::Wish wish) {
    const std::scoped_lock lock(mutex_);
    if (session_ != nullptr) {
        session_->post(wish);
    } else {
        early_.push_back(wish);
    }
}

}  // namespace cam::stream
