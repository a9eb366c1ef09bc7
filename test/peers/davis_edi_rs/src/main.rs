//! Deblurs the frames of an AEDAT4 file with davis-EDI-rs, at the start of each exposure.
//!
//!     davis_edi_rs_frames FOLDER FILE.aedat4 CONTRAST|searched OUT_FOLDER
//!
//! Writes OUT_FOLDER/START.png for each frame, START in microseconds, and prints one line for it: start,
//! contrast threshold, seconds. The library leaves out the first frame and the last one.

use davis_edi_rs::util::reconstructor::Reconstructor;
use opencv::core::{Mat, Vector, CV_8U};
use opencv::imgcodecs;
use opencv::prelude::*;
use std::error::Error;
use std::time::Instant;

/// 0 and 1 to 0 and 255 DN; the library cuts off at 1.1.
fn write_png(path: &str, image: &Mat) -> Result<(), Box<dyn Error>> {
    let mut bytes = Mat::default();
    image.convert_to(&mut bytes, CV_8U, 255.0, 0.0)?;
    if !imgcodecs::imwrite(path, &bytes, &Vector::new())? {
        return Err(format!("{path} could not be written").into());
    }
    Ok(())
}

#[tokio::main]
async fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().collect();
    let [_, folder, file, contrast, out] = words.as_slice() else {
        return Err("expected FOLDER FILE.aedat4 CONTRAST|searched OUT_FOLDER".into());
    };
    let searched = contrast == "searched";
    let start_c = if searched { 0.3 } else { contrast.parse()? };
    let mut reconstructor = Reconstructor::new(
        folder.clone(),
        file.clone(),
        String::new(),
        "file".to_string(),
        start_c,
        searched,
        1,     // contrast searched for each frame
        false, // no controller: a file has time
        false, // no window
        false, // nor one of blurry frames
        100.0, // frames per second of a video, which is not asked for
        true,  // deblurred frames alone
        false,
        500.0, // latency for the controller [ms]
        false, // not at the speed of the camera
    )
    .await?;
    loop {
        let begun = Instant::now();
        let Some(result) = reconstructor.next(true).await else {
            return Ok(());
        };
        let (image, _, details, _) = result.map_err(|error| error.to_string())?;
        let seconds = begun.elapsed().as_secs_f64();
        let (found, _, _, start_us, _) = details.ok_or("a frame without its exposure")?;
        write_png(&format!("{out}/{start_us}.png"), &image)?;
        println!("\nframe {start_us} {found} {seconds}");
    }
}
