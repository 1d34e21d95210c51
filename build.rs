//! Rebuilds the program, which embeds the folder `presets`, if a preset is added or changed.

fn main() {
    println!("cargo::rerun-if-changed=presets");
}
