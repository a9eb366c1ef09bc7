"""Parts of pictures side by side, each under its heading."""
import PIL.Image
import PIL.ImageDraw
import PIL.ImageFont

SIDE_PX = 196  # of the part that is shown
MAGNIFICATION = 2
GAP_PX, HEADING_PX, FONT_PX = 12, 44, 26
FONT = '/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf'
PAPER, INK = (255, 255, 255), (30, 30, 30)


def draw(panels, left, top, path):
    """Writes a picture of `panels`, pairs of heading and PIL image, from pixel (left, top) on."""
    side = SIDE_PX * MAGNIFICATION
    sheet = PIL.Image.new('RGB', (len(panels) * (side + GAP_PX) - GAP_PX, HEADING_PX + side), PAPER)
    pen = PIL.ImageDraw.Draw(sheet)
    font = PIL.ImageFont.truetype(FONT, FONT_PX)
    for i, (heading, picture) in enumerate(panels):
        part = picture.crop((left, top, left + SIDE_PX, top + SIDE_PX))
        x = i * (side + GAP_PX)
        sheet.paste(part.resize((side, side), PIL.Image.BICUBIC), (x, HEADING_PX))
        pen.text((x, (HEADING_PX - FONT_PX) // 2), heading, INK, font)
    sheet.save(path, optimize=True)
