//! Prints what gsd-parser reads from each file named on the command line, as lines of fields parted by tabs.

use gsd_parser::{parser, GenericStationDescription, PrmBuilder, SupportedSpeeds};

fn main() {
    for name in std::env::args().skip(1) {
        let path = std::path::PathBuf::from(&name);
        let bytes = std::fs::read(&path).expect("the file can be read");
        let source = String::from_utf8(bytes).expect("the file is UTF-8");
        println!("file\t{name}");
        match parser::parse(&path, &source) {
            Ok(gsd) => dump(&gsd),
            Err(error) => println!("error\t{}", error.to_string().replace('\n', " ")),
        }
    }
}

fn dump(gsd: &GenericStationDescription) {
    println!("GSD_Revision\t{}", gsd.gsd_revision);
    println!("Vendor_Name\t{}", gsd.vendor);
    println!("Model_Name\t{}", gsd.model);
    println!("Revision\t{}", gsd.revision);
    println!("Ident_Number\t{}", gsd.ident_number);
    println!("Hardware_Release\t{}", gsd.hardware_release);
    println!("Software_Release\t{}", gsd.software_release);
    println!("Freeze_Mode_supp\t{}", u8::from(gsd.freeze_mode_supported));
    println!("Sync_Mode_supp\t{}", u8::from(gsd.sync_mode_supported));
    println!("Auto_Baud_supp\t{}", u8::from(gsd.auto_baud_supported));
    println!(
        "Set_Slave_Add_supp\t{}",
        u8::from(gsd.set_slave_addr_supported)
    );
    println!("Fail_Safe\t{}", u8::from(gsd.fail_safe));
    println!("Max_Diag_Data_Len\t{}", gsd.max_diag_data_length);
    println!("Modular_Station\t{}", u8::from(gsd.modular_station));
    println!("Max_Module\t{}", gsd.max_modules);
    println!("Max_Input_Len\t{}", gsd.max_input_length);
    println!("Max_Output_Len\t{}", gsd.max_output_length);
    println!("Max_Data_Len\t{}", gsd.max_data_length);
    let speeds = &gsd.supported_speeds;
    let times = &gsd.max_tsdr;
    for (name, speed, time) in [
        ("9.6", SupportedSpeeds::B9600, times.b9600),
        ("19.2", SupportedSpeeds::B19200, times.b19200),
        ("31.25", SupportedSpeeds::B31250, times.b31250),
        ("45.45", SupportedSpeeds::B45450, times.b45450),
        ("93.75", SupportedSpeeds::B93750, times.b93750),
        ("187.5", SupportedSpeeds::B187500, times.b187500),
        ("500", SupportedSpeeds::B500000, times.b500000),
        ("1.5M", SupportedSpeeds::B1500000, times.b1500000),
        ("3M", SupportedSpeeds::B3000000, times.b3000000),
        ("6M", SupportedSpeeds::B6000000, times.b6000000),
        ("12M", SupportedSpeeds::B12000000, times.b12000000),
    ] {
        if speeds.contains(speed) {
            println!("rate\t{name}\t{time}");
        }
    }
    println!(
        "user_parameters\t{}",
        hexadecimal(PrmBuilder::new(&gsd.user_prm_data).as_bytes())
    );
    for module in &gsd.available_modules {
        println!(
            "module\t{}\t{}\t{}\t{}",
            module
                .reference
                .map_or(String::new(), |reference| reference.to_string()),
            module.name,
            hexadecimal(&module.config),
            module.info_text.as_deref().unwrap_or(""),
        );
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02X}")).collect()
}
