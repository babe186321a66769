"""MAVSDK in a thread of its own: opens the link, finds the autopilot, and begins anew when it has long been silent."""

import asyncio
import logging
from collections import deque
from collections.abc import Callable, Coroutine
from itertools import count
from threading import Thread
from typing import Any

from mavsdk.asyncio import ComponentType, Configuration, Mavsdk, MavsdkConnectionError
from mavsdk.logging import log_subscribe

from devices.drone.frame import LocalFrame
from devices.drone.pilot import Answered, News, NoLink, Order, Setpoint
from devices.drone.vehicle import Vehicle

log = logging.getLogger("autopilot")

AGAIN_S = 1.0
"""Between two tries to open a link."""
GIVE_UP_S = 6.0
"""A link over which nothing has come for this long is closed and opened anew."""
LOOK_S = 0.5
LAST_ORDERS_S = 2.5
"""MAVSDK itself gives up on an order after 2 s."""


class MavsdkPilot:
    """See devices.drone.pilot.Pilot. `height_m`: where the autopilot takes off to and returns at by itself."""

    def __init__(self, url: str, frame: LocalFrame, height_m: float, name: str) -> None:
        self._url, self._frame, self._height_m = url, frame, height_m
        self._loop = asyncio.new_event_loop()
        self._thread = Thread(target=self._run, name=f"mavsdk-{name}", daemon=True)
        self._news: deque[News] = deque(maxlen=2000)
        self._numbers = count(1)
        self._vehicle: Vehicle | None = None
        self._orders: set[asyncio.Task[None]] = set()
        self._fault: BaseException | None = None

    def start(self) -> None:
        self._thread.start()

    def ask(self, order: Order) -> int:
        number = next(self._numbers)
        self._pass(self._begin, number, order)
        return number

    def fly(self, setpoint: Setpoint) -> None:
        self._pass(self._pass_on, setpoint)

    def _pass(self, what: Callable[..., None], *of: object) -> None:
        """Into the thread; nowhere once that has failed, which `news` says."""
        if not self._loop.is_closed():
            self._loop.call_soon_threadsafe(what, *of)

    def news(self) -> list[News]:
        """Raises what went wrong in the thread: nobody would notice it there."""
        if self._fault is not None:
            raise self._fault
        return [self._news.popleft() for _ in range(len(self._news))]

    def stop(self) -> None:
        if self._thread.is_alive():
            asyncio.run_coroutine_threadsafe(self._end(), self._loop)
            self._thread.join(2.0 * LAST_ORDERS_S)

    # Below runs in the thread

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        self._main = self._loop.create_task(self._stay_connected())
        self._loop.run_until_complete(asyncio.wait([self._main]))
        self._note_fault(self._main)
        self._loop.run_until_complete(self._loop.shutdown_asyncgens())
        self._loop.close()

    def _note_fault(self, task: "asyncio.Task[None]") -> None:
        if not task.cancelled() and task.exception() is not None:
            self._fault = task.exception()

    async def _end(self) -> None:
        if self._orders:
            await asyncio.wait(self._orders, timeout=LAST_ORDERS_S)
        self._main.cancel()

    def _begin(self, number: int, order: Order) -> None:
        task = self._loop.create_task(self._obey(number, order))
        self._orders.add(task)
        task.add_done_callback(self._orders.discard)
        task.add_done_callback(self._note_fault)

    async def _obey(self, number: int, order: Order) -> None:
        reason = "no autopilot is there" if self._vehicle is None else await self._vehicle.obey(order)
        self._news.append(Answered(number, reason))

    def _pass_on(self, setpoint: Setpoint) -> None:
        if self._vehicle is not None:
            self._vehicle.fly(setpoint)

    async def _stay_connected(self) -> None:
        log_subscribe(lambda *_: True)  # it would write to stdout
        while True:
            async with Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION)) as sdk:
                try:
                    await sdk.add_any_connection(self._url)
                except MavsdkConnectionError as error:
                    self._news.append(NoLink(str(error)))
                    await asyncio.sleep(AGAIN_S)
                    continue
                system = await sdk.first_autopilot(timeout_s=GIVE_UP_S)
                if system is not None:
                    await self._attend(Vehicle(system, self._frame, self._news.append))

    async def _attend(self, vehicle: Vehicle) -> None:
        """Until nothing has been heard of it for long."""
        work: list[Coroutine[Any, Any, Any]] = [*vehicle.streams(), self._introduce(vehicle)]
        tasks = [self._loop.create_task(one) for one in work]
        try:
            while self._loop.time() - vehicle.heard_s < GIVE_UP_S:
                done, _ = await asyncio.wait(tasks, timeout=LOOK_S, return_when=asyncio.FIRST_EXCEPTION)
                for task in done:
                    task.result()
                tasks = [task for task in tasks if task not in done]
        finally:
            self._vehicle = None
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

    async def _introduce(self, vehicle: Vehicle) -> None:
        self._news.append(await vehicle.prepare(self._height_m))
        self._vehicle = vehicle
