//! `phaselab completions SHELL`: the script by which a shell completes commands, options and the names of presets.

use clap_complete::Shell;

use super::error::CommandError;
use super::output::{Output, OutputForm};

/// Print what a shell needs to complete commands, options and the names of presets.
///
/// In bash, zsh and fish the names of presets, including your own, are looked up when you complete
/// a word.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab completions bash > ~/.bash_completion.d/phaselab
  phaselab completions zsh > ~/.zfunc/_phaselab      with ~/.zfunc in $fpath
  phaselab completions fish > ~/.config/fish/completions/phaselab.fish")]
pub(super) struct Arguments {
    /// The shell.
    #[arg(value_enum, value_name = "SHELL")]
    shell: Shell,
}

/// `command` is the whole command line.
pub(super) fn execute(arguments: &Arguments, command: clap::Command) -> Result<(), CommandError> {
    Output::print(OutputForm::Text, &script(arguments.shell, command))
}

fn script(shell: Shell, mut command: clap::Command) -> String {
    let named = named(&command);
    let mut bytes = Vec::new();
    clap_complete::generate(shell, &mut command, "phaselab", &mut bytes);
    let generated = String::from_utf8_lossy(&bytes).into_owned();
    match shell {
        Shell::Bash => generated + &bash(&named),
        Shell::Zsh => zsh(&generated),
        // a word that is still missing, as after `--glyphs`, comes before any command
        Shell::Fish => generated.replacen("or return\n", "or return 0\n", 1) + &fish(&named),
        _ => generated,
    }
}

/// The placeholder for a preset's name in the usage of a command.
const PRESET: &str = "PRESET|FILE";

/// The commands that take a preset's name.
fn named(command: &clap::Command) -> Vec<String> {
    let takes = |argument: &clap::Arg| {
        argument.get_value_names().is_some_and(|names| names.iter().any(|name| name == PRESET))
    };
    let commands = command.get_subcommands();
    let named = commands.filter(|command| command.get_positionals().any(takes));
    named.map(|command| command.get_name().to_owned()).collect()
}

fn bash(named: &[String]) -> String {
    let places: Vec<String> = named.iter().map(|name| format!("|*:{name}")).collect();
    let places = places.concat();
    format!(
        r#"
# The names of presets where one may stand, beside what is generated above.
_phaselab_with_presets() {{
    local cur="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}" word
    local -a words=()
    _phaselab "$@"
    for word in "${{COMPREPLY[@]}}"; do
        [[ $word == [\<\[]* ]] || words+=("$word")
    done
    COMPREPLY=("${{words[@]}}")
    [[ $cur == -* || $cur == */* || $before == -* ]] && return 0
    case "$COMP_CWORD:${{COMP_WORDS[1]}}" in
        1:*{places})
            local IFS=$'\n'
            COMPREPLY+=($(compgen -W "$(phaselab list --format names 2>/dev/null)" -- "$cur"))
            COMPREPLY+=($(compgen -f -X '!*.toml' -- "$cur"))
            ;;
    esac
    return 0
}}

complete -F _phaselab_with_presets -o bashdefault -o default phaselab
"#
    )
}

/// Corrects the generated zsh script, which takes the lab's argument for a word before every command. The other
/// positions of presets are recognized by their help text.
fn zsh(generated: &str) -> String {
    let mut script = String::new();
    let mut functions = Some(
        r#"
# The names of presets, and files beside them.
_phaselab_presets() {
    local -a presets
    presets=(${(f)"$(phaselab list --format names 2>/dev/null)"})
    _alternative 'presets:preset:compadd -a presets' 'files:file:_files -g "*.toml"'
}

_phaselab_first() {
    _alternative 'commands:command:_phaselab_commands' 'presets:preset:_phaselab_presets'
}
"#,
    );
    for line in generated.lines().filter(|line| !line.starts_with("'::name -- ")) {
        if line.starts_with("_phaselab()") {
            script.extend(functions.take());
            script.push('\n');
        }
        let named = line.contains("name -- A preset") && line.contains(":_default'");
        let line =
            if named { line.replace(":_default'", ":_phaselab_presets'") } else { line.into() };
        let line = line.replace("\":: :_phaselab_commands\"", "\":: :_phaselab_first\"");
        script.push_str(&line.replace("$line[2]", "$line[1]"));
        script.push('\n');
    }
    script
}

fn fish(named: &[String]) -> String {
    let names = "-a '(phaselab list --format names 2>/dev/null)' -d preset";
    let lab = format!("complete -c phaselab -n __fish_phaselab_needs_command {names}\n");
    let of_command = |command: &String| {
        format!("complete -c phaselab -n '__fish_phaselab_using_subcommand {command}' {names}\n")
    };
    let others: Vec<String> = named.iter().map(of_command).collect();
    format!("\n# The names of presets, beside files.\n{lab}{}", others.concat())
}
