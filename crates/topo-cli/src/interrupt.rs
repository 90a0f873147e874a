//! Ctrl-C: the first asks for a tidy stop, the second ends the process at once.

use crate::error::CliError;
use topo_core::Interrupt;

/// Token that Ctrl-C raises.
pub fn install() -> Interrupt {
    let interrupt = Interrupt::new();
    let token = interrupt.clone();
    // A second handler cannot be set; the token then merely stays down.
    let _ = ctrlc::set_handler(move || {
        if token.is_requested() {
            std::process::exit(130);
        }
        token.request();
        note!("stopping; finished cases are kept (Ctrl-C again to stop at once)");
    });
    interrupt
}

/// An error once Ctrl-C was pressed.
pub fn check(interrupt: &Interrupt) -> Result<(), CliError> {
    if interrupt.is_requested() {
        Err(CliError::Interrupted)
    } else {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_raised_token_stops() {
        let interrupt = Interrupt::new();
        assert!(check(&interrupt).is_ok());
        interrupt.request();
        assert_eq!(check(&interrupt).unwrap_err().exit_code(), 130);
    }
}
