//! Battery, meters and battery profiles.

use super::layout::{Field, byte, i16, u8};
use super::{Call, Refused};
use crate::firmware::settings::{Scope, Value, find};

/// The size of one voltage meter's subframe, bytes.
const VOLTAGE_SUBFRAME: u8 = 5;
/// The size of one current meter's subframe, bytes.
const CURRENT_SUBFRAME: u8 = 6;
/// The meters that measure the battery.
pub(super) const METER_MEASURED: u8 = 10;
/// The current meter that computes from the throttle.
pub(super) const METER_VIRTUAL: u8 = 80;
/// The type of a current meter with a converter.
const CURRENT_ADC: u8 = 1;
const MAX_CELLS: u8 = 24;

const VOLTAGE_FIELDS: &[Field] = &[u8("vbat_scale"), u8("vbat_divider"), u8("vbat_multiplier")];
const CURRENT_MEASURED: &[Field] = &[i16("ibata_scale"), i16("ibata_offset")];
const CURRENT_VIRTUAL: &[Field] = &[i16("ibatv_scale"), i16("ibatv_offset")];

const MIN_CELL: &str = "vbat_min_cell_voltage";
const MAX_CELL: &str = "vbat_max_cell_voltage";
const WARNING_CELL: &str = "vbat_warning_cell_voltage";
const FULL_CELL: &str = "vbat_full_cell_voltage";

/// The voltage source of a converter, in the numbering of `battery_meter`.
const VOLTAGE_ADC: i64 = 1;

/// Returns the source of the voltage. A simulated battery is measured even if no meter is chosen.
fn voltage_source(call: &Call<'_>) -> i64 {
    match call.setting("battery_meter") {
        0 if call.facts.battery.is_some() => VOLTAGE_ADC,
        source => source,
    }
}

pub(super) fn battery_config(call: &mut Call<'_>) {
    let cells = [MIN_CELL, MAX_CELL, WARNING_CELL].map(|name| call.setting(name));
    let (capacity, voltage, current) =
        (call.setting("bat_capacity"), voltage_source(call), call.setting("current_meter"));
    for cell in cells {
        call.reply.u8((cell + 5) / 10);
    }
    call.reply.u16(capacity);
    call.reply.u8(voltage);
    call.reply.u8(current);
    for cell in cells {
        call.reply.u16(cell);
    }
}

pub(super) fn set_battery_config(call: &mut Call<'_>) -> Result<(), Refused> {
    if call.request.remaining() < 7 {
        return Err(Refused);
    }
    let request = &mut call.request;
    let coarse = [(); 3].map(|()| i64::from(request.u8()) * 10);
    let (capacity, voltage, current) = (request.u16(), request.u8(), request.u8());
    let [min, max, warning] =
        if request.remaining() >= 6 { [(); 3].map(|()| i64::from(request.u16())) } else { coarse };
    if !(min <= warning && warning <= max) {
        return Err(Refused);
    }
    call.set(MIN_CELL, min);
    call.set(MAX_CELL, max);
    call.set(WARNING_CELL, warning);
    call.set("bat_capacity", i64::from(capacity));
    // A client sends the displayed source back with every save. That must not choose a meter.
    if i64::from(voltage) != voltage_source(call) {
        call.set("battery_meter", i64::from(voltage));
    }
    call.set("current_meter", i64::from(current));
    Ok(())
}

pub(super) fn voltage_meter_config(call: &mut Call<'_>) {
    call.reply.bytes(&[1, VOLTAGE_SUBFRAME, METER_MEASURED, 0]);
    super::layout::read(VOLTAGE_FIELDS, &call.configuration.settings, &mut call.reply);
}

pub(super) fn set_voltage_meter_config(call: &mut Call<'_>) {
    if call.request.u8() == METER_MEASURED {
        super::layout::write(VOLTAGE_FIELDS, &mut call.configuration.settings, &mut call.request);
    }
}

pub(super) fn current_meter_config(call: &mut Call<'_>) {
    let settings = &call.configuration.settings;
    call.reply.bytes(&[2, CURRENT_SUBFRAME, METER_MEASURED, CURRENT_ADC]);
    super::layout::read(CURRENT_MEASURED, settings, &mut call.reply);
    call.reply.bytes(&[CURRENT_SUBFRAME, METER_VIRTUAL, 0]);
    super::layout::read(CURRENT_VIRTUAL, settings, &mut call.reply);
}

pub(super) fn set_current_meter_config(call: &mut Call<'_>) {
    let fields = match call.request.u8() {
        METER_MEASURED => CURRENT_MEASURED,
        METER_VIRTUAL => CURRENT_VIRTUAL,
        _ => return,
    };
    super::layout::write(fields, &mut call.configuration.settings, &mut call.request);
}

/// The numbers of a battery profile in wire order, without the profile's index: setting, size in bytes.
const PROFILE: [(&str, usize); 7] = [
    (MIN_CELL, 2),
    (MAX_CELL, 2),
    (WARNING_CELL, 2),
    (FULL_CELL, 2),
    ("bat_capacity", 2),
    ("force_battery_cell_count", 1),
    ("cbat_alert_percent", 1),
];

pub(super) fn battery_profile(call: &mut Call<'_>) -> Result<(), Refused> {
    let settings = &call.configuration.settings;
    let profile = match call.request.remaining() {
        0 => settings.active(Scope::BatteryProfile),
        _ => call.request.u8(),
    };
    if profile >= Scope::BatteryProfile.instances() {
        return Err(Refused);
    }
    call.reply.u8(profile);
    for (name, size) in PROFILE {
        let number = match find(name).and_then(|setting| settings.value(setting, profile)) {
            Some(Value::Number(number)) => *number,
            _ => 0,
        };
        if size == 2 {
            call.reply.u16(number);
        } else {
            call.reply.u8(number);
        }
    }
    Ok(())
}

pub(super) fn set_battery_profile(call: &mut Call<'_>) -> Result<(), Refused> {
    let profile = call.request.u8();
    let mut numbers = [0_i64; PROFILE.len()];
    for (number, (_, size)) in numbers.iter_mut().zip(PROFILE) {
        *number = if size == 2 { i64::from(call.request.u16()) } else { i64::from(call.request.u8()) };
    }
    let [min, max, warning, full, _, cells, alert_percent] = numbers;
    let in_order = min <= warning && warning <= full && full <= max;
    if profile >= Scope::BatteryProfile.instances()
        || !in_order
        || cells > i64::from(MAX_CELLS)
        || alert_percent > 100
    {
        return Err(Refused);
    }
    let settings = &mut call.configuration.settings;
    // All values are set, or no value is.
    let mut changed = settings.clone();
    for ((name, _), number) in PROFILE.into_iter().zip(numbers) {
        let setting = find(name).ok_or(Refused)?;
        changed.put(setting, profile, Value::Number(number)).map_err(|_| Refused)?;
    }
    *settings = changed;
    Ok(())
}

/// `RSSI_CONFIG`.
pub(super) const RSSI: &[Field] = &[u8("rssi_channel")];

/// `TRANSPONDER_CONFIG`: there is no transponder.
pub(super) const NONE: &[Field] = &[byte(0)];
