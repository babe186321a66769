"""What firmware decides: modes, arming, missions, setpoints, fence, failsafes, parameters."""
