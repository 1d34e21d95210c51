//! Tells cargo that the program holds the folder `presets`: a preset added or changed is a reason
//! to build again.

fn main() {
    println!("cargo::rerun-if-changed=presets");
}
