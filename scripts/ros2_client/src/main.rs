//! An independent ROS 2 client, which lists nodes and receives pings:
//!
//!     cargo run --release --manifest-path scripts/ros2_client/Cargo.toml -- /auv sonar 10
//!
//! Arguments: namespace and name of the topic, and duration in seconds. Exits with 1 if no ping arrived. Uses ROS_DOMAIN_ID.
use futures::StreamExt;
use ros2_client::{qos::History, *};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

#[derive(Serialize, Deserialize)]
struct Time {
    sec: i32,
    nanosec: u32,
}
#[derive(Serialize, Deserialize)]
struct Header {
    stamp: Time,
    frame_id: String,
}
#[derive(Serialize, Deserialize)]
struct PingInfo {
    frequency: f32,
    sound_speed: f32,
    tx_beamwidths: Vec<f32>,
    rx_beamwidths: Vec<f32>,
}
#[derive(Serialize, Deserialize)]
struct Vector3 {
    x: f64,
    y: f64,
    z: f64,
}
#[derive(Serialize, Deserialize)]
struct SonarImageData {
    is_bigendian: bool,
    dtype: u32,
    beam_count: u32,
    data: Vec<u8>,
}
#[derive(Serialize, Deserialize)]
struct ProjectedSonarImage {
    header: Header,
    ping_info: PingInfo,
    beam_directions: Vec<Vector3>,
    ranges: Vec<f32>,
    image: SonarImageData,
}
impl Message for ProjectedSonarImage {}

fn main() {
    let words: Vec<String> = std::env::args().collect();
    let word = |at: usize, otherwise: &str| words.get(at).cloned().unwrap_or(otherwise.into());
    let (space, name) = (word(1, "/auv"), word(2, "sonar"));
    let seconds: f64 = word(3, "10").parse().expect("seconds must be a number");
    let domain = std::env::var("ROS_DOMAIN_ID").ok().and_then(|id| id.parse().ok()).unwrap_or(0);

    let context = Context::with_options(ContextOptions::new().domain_id(domain)).expect("no domain");
    let mut node = context
        .new_node(NodeName::new("/", "ros2_client_check").unwrap(), NodeOptions::new().enable_rosout(false))
        .expect("no node");
    let executor = smol::Executor::new();
    executor.spawn(node.spinner().unwrap().spin()).detach();
    let events = node.status_receiver().unwrap();
    let qos = QosProfile::publisher_default().history(History::KeepLast { depth: 10 });
    let kind = MessageTypeName::new("marine_acoustic_msgs", "ProjectedSonarImage");
    let topic = node.create_topic(&Name::new(&space, &name).unwrap(), kind, &DEFAULT_SUBSCRIPTION_QOS).unwrap();
    let pings = node.create_subscription::<ProjectedSonarImage>(&topic, Some(qos)).unwrap();

    let mut nodes = BTreeSet::new();
    let mut latencies = Vec::new();
    let listen = async {
        let mut stream = Box::pin(pings.async_stream());
        while let Some(result) = stream.next().await {
            let (ping, _) = result.expect("a ping that cannot be read");
            let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_secs_f64();
            let stamp = ping.header.stamp;
            latencies.push(1e3 * (now - stamp.sec as f64 - stamp.nanosec as f64 * 1e-9));
            if latencies.len() == 1 {
                let size = ping.image.data.len();
                println!("first ping: {} beams, {} bins, {size} bytes", ping.image.beam_count, ping.ranges.len());
            }
        }
    };
    let graph = events.for_each(|event| {
        if let NodeEvent::ParticipantEntities(info) = event {
            for node in info.nodes() {
                if nodes.insert(node.fully_qualified_name()) {
                    println!("node {}", node.fully_qualified_name());
                }
            }
        }
        futures::future::ready(())
    });
    let end = smol::Timer::after(Duration::from_secs_f64(seconds));
    smol::block_on(executor.run(async {
        futures::future::select(Box::pin(futures::future::join(listen, graph)), end).await;
    }));
    if latencies.is_empty() {
        eprintln!("no ping on {space}/{name}");
        std::process::exit(1);
    }
    latencies.sort_by(f64::total_cmp);
    let at = |share: f64| latencies[(share * (latencies.len() - 1) as f64) as usize];
    println!("{} pings, {:.1} ms median, {:.1} ms p99 after their stamp", latencies.len(), at(0.5), at(0.99));
}
