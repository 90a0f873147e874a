//! Headless Chromium for tests: what a page becomes there, as text and as pixels.

use crate::outside::Outside;
use resvg::tiny_skia::{IntRect, Pixmap};
use std::path::{Path, PathBuf};
use std::process::Command;

/// A browser with a profile of its own.
pub struct Browser {
    program: PathBuf,
    folder: tempfile::TempDir,
}

/// Width and height of a window in CSS pixels.
pub type Size = [u32; 2];

/// Sends what a page found out, `report` in its script, to the frame around it.
pub const SEND: &str = "parent.postMessage(JSON.stringify(report), '*');";

/// How often a page is asked for its report.
const N_TRIES: usize = 3;

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

    /// Shows an address in a frame of a size, as windows cannot be narrower than 500 pixels, for `budget` milliseconds of the
    /// page's clock.
    fn show(&self, address: &str, [width, height]: Size, budget: u32, more: &[&str]) -> String {
        let frame = self.folder.path().join("frame.html");
        let text = format!(
            "<!DOCTYPE html><style>body{{margin:0}}iframe{{border:0;width:{width}px;height:{height}px;display:block}}</style>\
             <script>addEventListener('message',(e)=>{{document.title='REPORT'+e.data}})</script>\
             <iframe src=\"{}\"></iframe>",
            address.replace('"', "%22")
        );
        std::fs::write(&frame, text).unwrap();
        let profile = self.folder.path().join("profile");
        let output = Command::new(&self.program)
            .args(["--headless", "--no-sandbox", "--disable-dev-shm-usage"])
            .args([
                "--hide-scrollbars",
                "--use-gl=angle",
                "--use-angle=swiftshader",
            ])
            .arg("--enable-unsafe-swiftshader")
            .arg(format!("--virtual-time-budget={budget}"))
            .arg(format!("--window-size={},{}", width.max(500), height + 200))
            .arg(format!("--user-data-dir={}", profile.display()))
            .args(more)
            .arg(self::address(&frame))
            .output()
            .unwrap();
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    /// What the script of a page sent by [`SEND`]. On a loaded machine Chromium now and then ends before the page has drawn, so it
    /// is asked again.
    pub fn report(&self, address: &str, size: Size, budget: u32) -> serde_json::Value {
        let ask = |_| {
            let dom = self.show(address, size, budget, &["--dump-dom"]);
            let title = dom.split_once("<title>REPORT")?;
            Some(title.1.split_once("</title>")?.0.to_owned())
        };
        let text = (0..N_TRIES)
            .find_map(ask)
            .unwrap_or_else(|| panic!("no report from {address}"));
        serde_json::from_str(
            &text
                .replace("&lt;", "<")
                .replace("&gt;", ">")
                .replace("&amp;", "&"),
        )
        .unwrap()
    }

    /// The pixels of an address in a frame of a size, `zoom` a CSS pixel.
    pub fn screenshot(&self, address: &str, size: Size, zoom: u32, budget: u32) -> Pixmap {
        let file = self.folder.path().join("shot.png");
        let shot = format!("--screenshot={}", file.display());
        let scale = format!("--force-device-scale-factor={zoom}");
        self.show(address, size, budget, &[&shot, &scale]);
        let all = Pixmap::load_png(&file).unwrap();
        let frame = IntRect::from_xywh(0, 0, size[0] * zoom, size[1] * zoom).unwrap();
        all.clone_rect(frame).unwrap()
    }
}

/// Address of a file.
pub fn address(file: &Path) -> String {
    format!("file://{}", file.display())
}
