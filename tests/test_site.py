"""What holds on every page of the site, seen in a browser."""

from visitor import Visitor


def test_first_page_opens_from_its_folder(visitor: Visitor) -> None:
    page = visitor.open("index.html")
    assert page.title()
    assert page.locator("h1").count() == 1
    assert page.locator("html.live").count() == 1
