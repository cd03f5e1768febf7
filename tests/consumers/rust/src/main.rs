//! Says in words what passes on a CANopen bus: reads lines `identifier#data` in hexadecimal, as candump writes them.

use drivespec_devices::cob_ids;
use drivespec_devices::e94aycca::codes;
use drivespec_devices::e94aycca::errors::{device, emergency, sdo_abort};
use drivespec_devices::e94aycca::numbers::HeartbeatStatus;
use drivespec_devices::e94aycca::telegrams::{Emergency, Heartbeat, Sdo, SdoError};
use drivespec_devices::types::CobId;
use std::error::Error;
use std::io::BufRead;

fn main() -> Result<(), Box<dyn Error>> {
    for line in std::io::stdin().lock().lines() {
        let line = line?;
        match telegram(&line) {
            Ok(text) => println!("{text}"),
            Err(error) => println!("{line}: {error}"),
        }
    }
    Ok(())
}

fn telegram(line: &str) -> Result<String, Box<dyn Error>> {
    let (identifier, digits) = line.split_once('#').ok_or("no telegram")?;
    let identifier = u32::from_str_radix(identifier, 16)?;
    let data = (0..digits.len() / 2)
        .map(|byte| u8::from_str_radix(&digits[2 * byte..2 * byte + 2], 16))
        .collect::<Result<Vec<u8>, _>>()?;
    let node = |entry: CobId| entry.node(identifier);
    if let Some(node) = node(cob_ids::NMT_ERROR_CONTROL) {
        let status = HeartbeatStatus::try_from(Heartbeat::decode(&data)?.status_s())?;
        return Ok(format!("node {node}: {}", status.label()));
    }
    if let Some(node) = node(cob_ids::EMCY) {
        let message = Emergency::decode(&data)?;
        let kind = emergency::TABLE
            .get(message.error_code.into())
            .map_or("unknown", |entry| entry.name);
        let error = device::TABLE
            .get(message.message)
            .map_or("unknown", |entry| entry.name);
        return Ok(format!("node {node}: {kind} - {error}"));
    }
    if let Some(node) = node(cob_ids::SDO_TX).or(node(cob_ids::SDO_RX)) {
        if let Ok(refused) = SdoError::decode(&data) {
            let reason = sdo_abort::TABLE
                .get(refused.error_code)
                .map_or("unknown", |entry| entry.name);
            return Ok(format!(
                "node {node}: refused {}: {reason}",
                code(refused.index)
            ));
        }
        let telegram = Sdo::decode(&data)?;
        return Ok(format!(
            "node {node}: {}/{} = {}",
            code(telegram.index),
            telegram.subindex,
            telegram.data
        ));
    }
    Ok(format!("{identifier:03X}: {data:02X?}"))
}

fn code(index: u16) -> String {
    codes::TABLE
        .get_by_index(index)
        .map_or_else(|| format!("I-{index:04X}"), |code| code.name.to_string())
}
