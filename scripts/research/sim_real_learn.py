"""Classifiers for scripts/research/sim_to_real: a small CNN (torch) and HOG with a linear SVM (scikit-image, scikit-learn)."""
import numpy as np
from PIL import Image

SIDE = 40  # of the input of a classifier [px]


def normalised(pixels, side=SIDE):
    """One size and one contrast: the rank of each pixel in its crop, 0 to 1, to the power of 3, since most pixels of a crop are dark. Ranks are the same for
    any gain and gamma of a display, until pixels are white. Equal pixels have one rank, the mean."""
    _, index, counts = np.unique(pixels, return_inverse=True, return_counts=True)
    ranks = (np.cumsum(counts) - (counts + 1) / 2) / max(pixels.size - 1, 1)
    levels = (ranks[index].reshape(pixels.shape) ** 3).astype(np.float32)
    return np.array(Image.fromarray(levels, "F").resize((side, side), Image.Resampling.BOX if min(levels.shape) > side else Image.Resampling.BILINEAR))


def arrays(crops, labels, sizes):
    """(x, y): x has the crop and, everywhere the same, the logarithm of its height over its width. If sizes are used, there is a third
    channel: the logarithm of its size over 64 pixels."""
    x = np.zeros((len(crops), 3 if sizes else 2, SIDE, SIDE), np.float32)
    for each, crop in zip(x, crops):
        height, width = crop.pixels.shape
        each[0] = normalised(crop.pixels)
        each[1] = np.log2(height / width).clip(-3, 3)
        if sizes:
            each[2] = (np.log2(height * width) / 2 - 6).clip(-3, 3)
    return x, np.array([labels.index(crop.label) for crop in crops])


def evidence(kind, count, part, x, seed):
    """Returns [n, count]: evidence for each class of x by a classifier that learns from a part (crops, classes)."""
    model = kind(count)
    model.learn(*part, seed)
    return model.evidence(x)


def weights(y, count):
    """Returns probabilities that give each class equal weight."""
    counts = np.bincount(y, minlength=count)
    return 1 / counts[y] / (counts > 0).sum()


def scores(truth, found, count):
    confusion = np.zeros((count, count), int)
    np.add.at(confusion, (truth, found), 1)
    hits, given, there = np.diag(confusion), confusion.sum(0), confusion.sum(1)
    f1 = 2 * hits / np.maximum(given + there, 1)
    return {"accuracy": float(hits.sum() / confusion.sum()), "macro_f1": float(f1.mean()), "confusion": confusion.tolist()}


class Hog:
    name = "HOG with 8 x 8 mean levels, linear SVM"

    def __init__(self, count, copies=1):
        self.count, self.copies = count, copies

    @staticmethod
    def features(x):
        from skimage.feature import hog
        small = x[:, 0].reshape(len(x), 8, SIDE // 8, 8, SIDE // 8).mean((2, 4)).reshape(len(x), -1)
        return np.hstack([np.stack([hog(each, 9, (8, 8), (2, 2), feature_vector=True) for each in x[:, 0]]), 0.3 * small,
                          0.3 * x[:, 1:, 0, 0]])

    def learn(self, x, y, seed):
        from sklearn.svm import LinearSVC
        rng = np.random.default_rng(seed)
        x, y = np.concatenate([x] + [varied(x, rng) for _ in range(self.copies)]), np.tile(y, 1 + self.copies)
        share = weights(y, self.count)
        self.svm = LinearSVC(C=0.03, random_state=seed, max_iter=3000)
        self.svm.fit(self.features(x), y, sample_weight=share / share.mean())

    def evidence(self, x):
        """Distances to the planes between classes."""
        distance = self.svm.decision_function(self.features(x))
        return distance if distance.ndim == 2 else np.stack([-distance, distance], 1)


def varied(x, rng):
    """Crops mirrored, rotated and scaled at random, with another contrast, blur and noise. For HOG; `augmented` is for the CNN."""
    from scipy import ndimage
    result = np.empty_like(x)
    for i, each in enumerate(x[:, 0]):
        angle, scale = rng.uniform(-0.35, 0.35), rng.uniform(0.8, 1.25, 2) * (1, rng.choice([-1, 1]))
        matrix = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]) * scale
        centre = (np.array(each.shape) - 1) / 2
        moved = ndimage.affine_transform(each, matrix, centre - matrix @ centre + rng.uniform(-2, 2, 2), order=1, mode="reflect")
        moved = ndimage.gaussian_filter(moved, rng.uniform(0, 0.8)) ** np.exp(rng.uniform(-0.7, 0.7))
        result[i, 1] = x[i, 1] + np.log2(scale[0] / abs(scale[1])) + rng.normal(0, 0.3)
        result[i, 2:] = x[i, 2:] + rng.normal(0, 0.4)
        result[i, 0] = np.clip(moved + rng.uniform(0, 0.2) * np.abs(rng.normal(size=each.shape)), 0, 1)
    return result


class Cnn:
    name = "CNN of three layers"

    def __init__(self, count, steps=450, batch=64):
        self.count, self.steps, self.batch = count, steps, batch

    def learn(self, x, y, seed):
        import torch
        torch.set_num_threads(1)  # the network is too small to use several threads; several networks are trained at a time
        torch.manual_seed(seed)
        rng = np.random.default_rng(seed)
        layers, before = [], x.shape[1]
        for channels in (16, 32, 64):
            layers += [torch.nn.Conv2d(before, channels, 3, padding=1), torch.nn.BatchNorm2d(channels), torch.nn.ReLU(),
                       torch.nn.MaxPool2d(2)]
            before = channels
        self.net = torch.nn.Sequential(*layers, torch.nn.AdaptiveAvgPool2d(2), torch.nn.Flatten(), torch.nn.Dropout(0.3),
                                       torch.nn.Linear(4 * before, self.count)).to(memory_format=torch.channels_last)
        share = weights(y, self.count)
        optimiser = torch.optim.AdamW(self.net.parameters(), 3e-3, weight_decay=1e-2)
        plan = torch.optim.lr_scheduler.OneCycleLR(optimiser, 3e-3, total_steps=self.steps)
        self.net.train()
        for _ in range(self.steps):
            chosen = rng.choice(len(x), self.batch, p=share)
            loss = torch.nn.functional.cross_entropy(self.net(augmented(torch.from_numpy(x[chosen]))), torch.from_numpy(y[chosen]),
                                                     label_smoothing=0.1)
            optimiser.zero_grad()
            loss.backward()
            optimiser.step()
            plan.step()
        self.net.eval()

    def evidence(self, x):
        """Logarithms of the mean probabilities for a crop and its mirror image. Probabilities below 1e-4 are not reliable."""
        import torch
        with torch.no_grad():
            x = torch.from_numpy(x)
            return ((self.net(x).softmax(1) + self.net(x.flip(3)).softmax(1)) / 2 + 1e-4).log().numpy()


def augmented(x):
    """Mirrored, turned, sheared and scaled at random; with other contrast, noise and blur; at times without proportions or size."""
    import torch
    n = len(x)
    x, proportion, size = x[:, :1], x[:, 1:2], x[:, 2:]  # no size where sizes are not used
    size = (size + 0.4 * torch.randn(n, 1, 1, 1)) * (torch.rand(n, 1, 1, 1) < 0.8)
    turn, tilt = (torch.rand(n) - 0.5) * 0.7, (torch.rand(n) - 0.5) * 0.4
    width, height = 0.8 + 0.45 * torch.rand(2, n)
    proportion = proportion + (torch.log2(width / height) + 0.4 * torch.randn(n))[:, None, None, None]
    proportion = proportion * (torch.rand(n, 1, 1, 1) < 0.8)
    width = width * (torch.randint(0, 2, (n,)) * 2 - 1)
    matrix = torch.stack([torch.stack([turn.cos() * width, tilt - turn.sin() * height, (torch.rand(n) - 0.5) * 0.3], 1),
                          torch.stack([turn.sin() * width, turn.cos() * height, (torch.rand(n) - 0.5) * 0.3], 1)], 1)
    grid = torch.nn.functional.affine_grid(matrix, x.shape, align_corners=False)
    x = torch.nn.functional.grid_sample(x, grid, padding_mode="reflection", align_corners=False)
    blurred = torch.nn.functional.avg_pool2d(torch.nn.functional.pad(x, (1, 1, 1, 1), mode="reflect"), 3, 1)
    x = torch.lerp(x, blurred, torch.rand(n, 1, 1, 1))
    streaked = torch.nn.functional.avg_pool2d(torch.nn.functional.pad(x, (4, 4, 0, 0), mode="reflect"), (1, 9), 1)  # wide beams, near field
    x = torch.lerp(x, streaked, torch.rand(n, 1, 1, 1) * torch.randint(0, 2, (n, 1, 1, 1)))
    x = with_background(x).clamp(0, 1) ** torch.exp((torch.rand(n, 1, 1, 1) - 0.5) * 1.4)
    noise = torch.rand(n, 1, 1, 1) * 0.25 * torch.randn_like(x).abs()
    x = (x + noise * torch.randint(0, 2, (n, 1, 1, 1))).clamp(0, 1)
    return torch.cat([x, proportion.expand_as(x), size], 1).contiguous(memory_format=torch.channels_last)


def with_background(x):
    """Crops with noise that begins at a random row, as reverberation behind or before an object, and with a gain over rows, as of TVG."""
    import torch
    n, side, pool = len(x), x.shape[-1], torch.nn.functional
    at_times = lambda share: torch.rand(n, 1, 1, 1) < share  # noqa: E731
    row = torch.linspace(-1, 1, side)[:, None]
    begin, sharp = (torch.rand(n, 1, 1, 1) - 0.5) * 2.4, torch.exp(torch.rand(n, 1, 1, 1) * 3)
    speckle = -2 * torch.rand(n, 1, side, side).clamp(min=0.01).log()  # energy
    speckle = torch.where(at_times(0.5), 1.3 * pool.avg_pool2d(pool.pad(speckle, (2, 2, 0, 0), mode="reflect"), (1, 5), 1), speckle) / 2
    level = torch.rand(n, 1, 1, 1) * 0.5 * at_times(0.6)
    x = (x**4 + level**2 * torch.sigmoid(2 * (row - begin) * sharp) * speckle) ** 0.25  # x is about the root of an amplitude
    return x * torch.exp((torch.rand(n, 1, 1, 1) - 0.35) * 0.8 * row * at_times(0.5))


def classifier(wanted):
    """Returns the class and name of the wanted classifier, or HOG where torch is missing."""
    if wanted == "cnn":
        try:
            import torch  # noqa: F401
            return Cnn, Cnn.name
        except ImportError:
            return Hog, f"{Hog.name} (torch is not installed)"
    return Hog, Hog.name


def nearest(from_crops, to_crops):
    """Returns the distance of each crop to its nearest neighbour: 16 x 16 pixels without mean and contrast, 0 to 2."""
    def flat(crops):
        x = np.stack([normalised(crop.pixels, 16).ravel() for crop in crops])
        x -= x.mean(1, keepdims=True)
        return x / np.maximum(np.linalg.norm(x, axis=1, keepdims=True), 1e-6)
    alike = flat(from_crops) @ flat(to_crops).T
    if from_crops is to_crops:
        np.fill_diagonal(alike, -1)
    return np.sqrt(np.maximum(0, 2 - 2 * alike.max(1)))
