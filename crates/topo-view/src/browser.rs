//! Headless Chromium for tests: what a page becomes there, as text and as pixels.

use crate::outside::Outside;
use resvg::tiny_skia::{IntRect, Pixmap};
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::mpsc;
use std::time::Duration;

/// A browser with a profile of its own.
pub struct Browser {
    program: PathBuf,
    folder: tempfile::TempDir,
}

/// Width and height of a window in CSS pixels.
pub type Size = [u32; 2];

/// Sends what a page found out, `report` in its script, to the frame around it.
pub const SEND: &str = "parent.postMessage(JSON.stringify(report), '*');";

/// How long a page may take to report on a loaded machine.
const PATIENCE: Duration = Duration::from_secs(180);

/// What stands before a report on the console.
const REPORT: &str = "REPORT";

impl Browser {
    /// The browser of this machine; panics where there is none.
    pub fn start() -> Self {
        Self {
            program: Outside::Browser
                .find()
                .unwrap_or_else(|| panic!("{}", Outside::Browser.needs())),
            folder: tempfile::tempdir().unwrap(),
        }
    }

    /// A browser that shows an address in a frame of a size, as windows cannot be narrower than 500 pixels.
    fn shows(&self, address: &str, [width, height]: Size) -> Command {
        let frame = self.folder.path().join("frame.html");
        let text = format!(
            "<!DOCTYPE html><style>body{{margin:0}}iframe{{border:0;width:{width}px;height:{height}px;display:block}}</style>\
             <script>addEventListener('message',(e)=>console.log('{REPORT}'+e.data))</script>\
             <iframe src=\"{}\"></iframe>",
            address.replace('"', "%22")
        );
        std::fs::write(&frame, text).unwrap();
        let profile = self.folder.path().join("profile");
        let mut command = Command::new(&self.program);
        command
            .args(["--headless", "--no-sandbox", "--disable-dev-shm-usage"])
            .args([
                "--hide-scrollbars",
                "--use-gl=angle",
                "--use-angle=swiftshader",
            ])
            .arg("--enable-unsafe-swiftshader")
            .arg(format!("--window-size={},{}", width.max(500), height + 200))
            .arg(format!("--user-data-dir={}", profile.display()));
        command
    }

    /// What the script of a page sent by [`SEND`]: the browser writes it to its console, and ends then.
    pub fn report(&self, address: &str, size: Size) -> serde_json::Value {
        let mut browser = self
            .shows(address, size)
            .arg("--enable-logging=stderr")
            .arg(self.frame())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let console = BufReader::new(browser.stderr.take().unwrap());
        let (send, receive) = mpsc::channel();
        std::thread::spawn(move || {
            let report = console
                .lines()
                .map_while(Result::ok)
                .find_map(|line| Some(line.split_once(REPORT)?.1.to_owned()));
            _ = send.send(report);
        });
        let text = receive.recv_timeout(PATIENCE);
        _ = browser.kill();
        _ = browser.wait();
        let text = text
            .ok()
            .flatten()
            .unwrap_or_else(|| panic!("no report from {address} in {PATIENCE:?}"));
        // the console adds where the line comes from
        serde_json::Deserializer::from_str(&text)
            .into_iter()
            .next()
            .unwrap()
            .unwrap()
    }

    /// The pixels of an address in a frame of a size, `zoom` a CSS pixel, after `budget` milliseconds of the page's clock.
    pub fn screenshot(&self, address: &str, size: Size, zoom: u32, budget: u32) -> Pixmap {
        let file = self.folder.path().join("shot.png");
        let shot = format!("--screenshot={}", file.display());
        let scale = format!("--force-device-scale-factor={zoom}");
        self.shows(address, size)
            .args([shot, scale, format!("--virtual-time-budget={budget}")])
            .arg(self.frame())
            .output()
            .unwrap();
        let all = Pixmap::load_png(&file).unwrap();
        let frame = IntRect::from_xywh(0, 0, size[0] * zoom, size[1] * zoom).unwrap();
        all.clone_rect(frame).unwrap()
    }

    fn frame(&self) -> String {
        address(&self.folder.path().join("frame.html"))
    }
}

/// Address of a file.
pub fn address(file: &Path) -> String {
    format!("file://{}", file.display())
}
