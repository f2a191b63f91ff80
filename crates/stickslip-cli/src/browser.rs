//! The browser of the person who types, where there is one.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// How long a program is watched that shall open a page: one that cannot says so at once, one that can may go on as long as the page is open.
const WATCHED: Duration = Duration::from_millis(1500);

/// Opens a page; `false` where nothing here can.
pub fn open(page: &Path) -> bool {
    let page = std::path::absolute(page).unwrap_or_else(|_| page.to_path_buf());
    let variable = |name: &str| std::env::var(name).unwrap_or_default();
    let screen = ["DISPLAY", "WAYLAND_DISPLAY", "WSL_DISTRO_NAME"];
    let screen = screen.iter().any(|name| !variable(name).is_empty());
    programs(&variable("BROWSER"), std::env::consts::OS, screen)
        .iter()
        .any(|program| opens(program, &page))
}

/// What may open a page, in the order in which it is tried: what the variable `BROWSER` names, and what the system has, if there is a screen.
fn programs(named: &str, system: &str, screen: bool) -> Vec<Vec<String>> {
    let words = |line: &str| line.split_whitespace().map(str::to_string).collect();
    let apart = if system == "windows" { ';' } else { ':' };
    let own: &[&str] = match system {
        "macos" => &["open"],
        "windows" => &["explorer.exe"],
        // Elsewhere the desktop is asked, which does not wait where there is no screen to show anything on.
        _ if screen => &["xdg-open", "wslview", "gio open"],
        _ => &[],
    };
    let named = named.split(apart).filter(|line| !line.trim().is_empty());
    named.chain(own.iter().copied()).map(words).collect()
}

/// Whether a program opens the page: it begins, and does not fail while it is watched.
fn opens(program: &[String], page: &Path) -> bool {
    let Some((name, rest)) = program.split_first() else {
        return false;
    };
    let mut command = Command::new(name);
    let page = page.as_os_str();
    if rest.iter().any(|word| word.contains("%s")) {
        command.args(
            rest.iter()
                .map(|word| word.replace("%s", &page.to_string_lossy())),
        );
    } else {
        command.args(rest).arg(page);
    }
    let quiet = command.stdin(Stdio::null()).stdout(Stdio::null());
    let Ok(mut child) = quiet.stderr(Stdio::null()).spawn() else {
        return false;
    };
    let begun = Instant::now();
    loop {
        match child.try_wait() {
            // Explorer ends with 1 whatever it does.
            Ok(Some(status)) => return status.success() || cfg!(windows),
            Ok(None) if begun.elapsed() < WATCHED => {
                std::thread::sleep(Duration::from_millis(20));
            }
            Ok(None) => return true,
            Err(_) => return false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_user_names_comes_before_what_the_system_has() {
        let all = programs("firefox --new-tab %s:lynx", "linux", true);
        assert_eq!(all[0], ["firefox", "--new-tab", "%s"]);
        assert_eq!(all[1], ["lynx"]);
        assert_eq!(all[2], ["xdg-open"]);
        assert_eq!(programs("", "macos", false), [["open"]]);
        assert_eq!(programs("C:\\a.exe", "windows", false)[0], ["C:\\a.exe"]);
    }

    #[test]
    fn nothing_is_tried_where_there_is_no_screen() {
        assert!(programs("", "linux", false).is_empty());
        assert_eq!(programs(" : ", "freebsd", false), Vec::<Vec<String>>::new());
    }

    #[test]
    fn a_program_that_is_not_there_opens_nothing() {
        let missing = ["there-is-no-such-program".to_string()];
        assert!(!opens(&missing, Path::new("page.html")));
        assert!(!opens(&[], Path::new("page.html")));
    }

    #[test]
    #[cfg(unix)]
    fn a_program_that_fails_opens_nothing() {
        let words = |line: &str| line.split(' ').map(str::to_string).collect::<Vec<_>>();
        assert!(!opens(&words("false"), Path::new("page.html")));
        assert!(opens(&words("test %s = page.html"), Path::new("page.html")));
        assert!(!opens(
            &words("test %s = other.html"),
            Path::new("page.html")
        ));
    }
}
