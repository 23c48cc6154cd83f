// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/profile/link.h"

#include "cam/profile/field_table_detail.h"
#include "cam/profile/link_fields_detail.h"
#include "cam/profile/profile_files_detail.h"

#include <algorithm>
#include <array>

namespace cam::profile {

using decomp::fail;
using decomp::Result;
namespace fs = std::filesystem;

namespace {

constexpr const char* kLinks = "links";

const Table<Link::Line>& line_rows() {
    using L = Link::Line;
    static const Table<L> rows = {
        {"protocol", &L::protocol, "", 0, 0, kRequired,
         "marlin, grbl (Grbl 1.1, grblHAL, FluidNC), modbus (a PLC with the G-code mailbox), or "
         "card: "
         "the program is carried to it"},
        {"baud", &L::baud, "", 1200, 4000000, kOptional, "bits a second"},
        {"rts_cts", &L::rts_cts, "", 0, 0, kOptional, "hardware flow control"},
        {"reset_on_open", &L::reset_on_open, "", 0, 0, kOptional,
         "the board restarts when the port is opened: its banner is waited for"},
        {"reset_on_close", &L::reset_on_close, "", 0, 0, kOptional,
         "DTR drops when the port is closed, and the next sender resets the board"},
        {"pulse_dtr", &L::pulse_dtr, "", 0, 0, kOptional,
         "DTR is dropped for a moment after opening, for boards that need it to start"},
        {"banner_wait_s", &L::banner_wait_s, "s", 0, 60, kOptional, "for the banner at most"},
        {"silence_s", &L::silence_s, "s", 0.01, 60, kOptional,
         "without a sign of life: the machine is asked where it stands"},
        {"patience_s", &L::patience_s, "s", 1, 7200, kOptional,
         "without a sign of life: the job is given up"},
        {"receive_bytes", &L::receive_bytes, "", 16, 65536, kOptional,
         "in flight at most, unless the machine tells its buffer"},
        {"window", &L::window, "", 1, 16, kOptional,
         "lines in flight at most; above 1 only for firmware with ADVANCED_OK"},
        {"max_resend_fraction", &L::max_resend_fraction, "", 0, 1, kOptional,
         "of a hundred lines sent again before the job is paused; 1: never"},
        {"precheck", &L::precheck, "", 0, 0, kOptional,
         "grbl reads the whole job in its check mode before anything moves"},
    };
    return rows;
}

const Table<Link::Identity>& identity_rows() {
    using I = Link::Identity;
    static const Table<I> rows = {
        {"firmware", &I::firmware, "", 0, 0, kOptional,
         "what the firmware's name must contain; empty: anything"},
        {"machine", &I::machine, "", 0, 0, kOptional,
         "what the machine's name (M115, $I) must contain; empty: anything"},
        {"usb", &I::usb, "", 0, 0, kOptional,
         "vendor:product of its port, for --port auto, e.g. \"2c99:0002\""},
    };
    return rows;
}

const Table<Link::Mill>& mill_rows() {
    using M = Link::Mill;
    static const Table<M> rows = {
        {"max_feed_mm_per_min", &M::max_feed_mm_per_min, "mm/min", 1, 100000, kOptional,
         "that a program may ask for"},
        {"max_spindle_rpm", &M::max_spindle_rpm, "rpm", 1, 100000, kOptional,
         "that a program may ask for"},
        {"spin_up_s", &M::spin_up_s, "s", 0, 120, kOptional,
         "from the start of the spindle until it may cut, after a tool change and on resuming"},
        {"parks", &M::parks, "", 0, 0, kOptional, "the spindle rises before a change of tool"},
        {"park_z_mm", &M::park_z_mm, "mm", -2000, 2000, kOptional,
         "where to, in machine coordinates"},
    };
    return rows;
}

const Table<Link::Modbus>& modbus_rows() {
    using M = Link::Modbus;
    static const Table<M> rows = {
        {"port", &M::port, "", 0, 0, kOptional,
         "where it is, for --port auto: tcp:HOST:PORT or a serial device"},
        {"unit", &M::unit, "", 1, 247, kOptional, "its number on the bus"},
        {"timeout_s", &M::timeout_s, "s", 0.01, 10, kOptional, "until an answer is given up"},
        {"watchdog_s", &M::watchdog_s, "s", 0.1, 60, kOptional,
         "without a sign of the sender: the machine holds; at least three timeouts"},
        {"parity", &M::parity, "", 0, 0, kOptional, "of a serial line: N, E or O"},
        {"stop_bits", &M::stop_bits, "", 1, 2, kOptional, "of a serial line"},
        {"combined", &M::combined, "", 0, 0, kOptional,
         "it has function 23; else 16 and then read_function (found out by itself, too)"},
        {"read_function", &M::read_function, "", 3, 4, kOptional, "3: holding, 4: input registers"},
        {"low_word_first", &M::low_word_first, "", 0, 0, kOptional, "of values of 32 bits"},
        {"low_byte_first", &M::low_byte_first, "", 0, 0, kOptional, "of text"},
        {"registers", &M::registers, "", 0, 0, kOptional,
         "those that lie elsewhere than docs/modbus-mailbox.md says, e.g. \"slot_area=4096\""},
    };
    return rows;
}

decomp::Status check_modbus(const Link& link, const std::string& path) {
    const std::string& parity = link.modbus.parity;
    if (parity != "N" && parity != "E" && parity != "O") {
        return fail("profile.inconsistent", "modbus.parity is N, E or O, not '" + parity + "'",
                    path);
    }
    if (link.modbus.watchdog_s < 3 * link.modbus.timeout_s) {
        return fail("profile.inconsistent",
                    "modbus.watchdog_s is less than three times modbus.timeout_s: one lost answer "
                    "would hold the machine",
                    path);
    }
    return {};
}

}  // namespace

std::vector<Field> fields_of(Link& link) {
    std::vector<Field> out;
    bind(out, File::Link, "link", line_rows(), link.line);
    bind(out, File::Link, "identity", identity_rows(), link.identity);
    bind(out, File::Link, "mill", mill_rows(), link.mill);
    bind(out, File::Link, "modbus", modbus_rows(), link.modbus);
    return out;
}

Result<Link> read_link(std::string_view machine, const std::vector<std::string>& settings) {
    std::vector<fs::path> roots = search_path();
    std::string name(machine);
    if (is_path(machine)) {
        // A machine given by its path brings its link along.
        const fs::path path{name};
        roots.insert(roots.begin(), path.parent_path() / "..");
        name = path.stem().string();
    }
    const Result<Found> found = find_profile(roots, kLinks, name);
    if (!found) {
        decomp::Error error = found.error();
        error.message = "nothing is known of how '" + name + "' is connected";
        error.hint = "write machine_profiles/links/" + name + ".toml; see docs/streaming.md";
        return fail(error);
    }
    Link link;
    link.name = name;
    std::vector<Field> fields = fields_of(link);
    const decomp::Status read = read_into(fields, File::Link, found->path).and_then([&] {
        return apply_settings(fields, settings);
    });
    if (!read) {
        return fail(read.error());
    }
    constexpr std::array<std::string_view, 4> kProtocols = {"marlin", "grbl", "modbus", "card"};
    if (std::find(kProtocols.begin(), kProtocols.end(), link.line.protocol) == kProtocols.end()) {
        return fail("profile.inconsistent", "there is no protocol '" + link.line.protocol + "'",
                    found->path.string(), "protocols are marlin, grbl, modbus and card");
    }
    if (const decomp::Status checked = check_modbus(link, found->path.string()); !checked) {
        return fail(checked.error());
    }
    return link;
}

std::vector<FieldRow> describe(const Link& link) {
    Link copy = link;
    std::vector<FieldRow> rows;
    for (const Field& field : fields_of(copy)) {
        rows.push_back({field.section, field.key, toml_text(field.target), field.unit,
                        range_text(field), field.required, field.doc});
    }
    return rows;
}

}  // namespace cam::profile
