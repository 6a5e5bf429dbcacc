//! Completions and the man page, from the definition of the arguments.

use clap::CommandFactory;
use clap_complete::Shell;
use clap_mangen::Man;

use crate::args::Cli;
use crate::failure::{OK, Outcome};
use crate::say::print;

/// `nephroid completions SHELL`.
pub fn completions(shell: Shell) -> Outcome {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "nephroid", &mut script);
    print(&String::from_utf8_lossy(&script))?;
    Ok(OK)
}

/// `nephroid man`.
pub fn man() -> Outcome {
    print(&page()?)?;
    Ok(OK)
}

/// One page for all commands: that of `nephroid`, then a section for each command.
fn page() -> std::io::Result<String> {
    let mut command = Cli::command().disable_help_subcommand(true);
    command.build();
    let man = Man::new(command.clone());
    let mut page = Vec::new();
    man.render_title(&mut page)?;
    man.render_name_section(&mut page)?;
    man.render_synopsis_section(&mut page)?;
    man.render_description_section(&mut page)?;
    man.render_options_section(&mut page)?;
    let mut page = String::from_utf8_lossy(&page).into_owned();
    for sub in command.get_subcommands() {
        let man = Man::new(sub.clone());
        let mut section = Vec::new();
        man.render_synopsis_section(&mut section)?;
        man.render_description_section(&mut section)?;
        man.render_options_section(&mut section)?;
        page += &format!(".SH \"NEPHROID {}\"\n", sub.get_name().to_uppercase());
        page += &String::from_utf8_lossy(&section).replace(".SH ", ".SS ");
    }
    Ok(page)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_has_every_flag() {
        let page = page().unwrap().replace("\\-", "-");
        for command in Cli::command().get_subcommands() {
            assert!(page.contains(&format!("NEPHROID {}", command.get_name().to_uppercase())));
            for flag in command.get_arguments().filter_map(clap::Arg::get_long) {
                assert!(page.contains(&format!("--{flag}")), "{flag}");
            }
        }
    }
}
