// Builds a viewer when it comes near the window, or when the address names one of its states.

const viewers = {};

function begin(name, build) {
  const box = document.getElementById('viewer-' + name);
  if (!box || !index[name]) return;
  let built = null;
  const open = () => (built = built || load('three').then(() => build(box)));
  const failed = (error) => {
    box.querySelector('.said').textContent = 'No 3D view here: ' + error.message;
    box.dataset.ready = 'no';
  };
  const done = () => { if (box.dataset.ready !== 'no') box.dataset.ready = 'yes'; };
  const near = new IntersectionObserver((entries) => {
    if (!entries.some((e) => e.isIntersecting)) return;
    near.disconnect();
    open().then((v) => (box.dataset.state === undefined && !box.dataset.asked ? v.first() : null)).then(done, failed);
  }, { rootMargin: '400px' });
  near.observe(box);
  viewers[name] = (text) => {
    box.dataset.asked = 'yes';
    open().then((v) => {
      const show = v.state(text);
      if (show) box.scrollIntoView();
      return show ? show() : v.first();
    }).then(done, failed);
  };
}

function follow() {
  const text = decodeURIComponent(location.hash.slice(1));
  const name = text.startsWith('q=') ? 'nematic' : text.includes(',') ? 'elastic' : null;
  if (viewers[name]) viewers[name](text);
}

begin('elastic', elastic);
begin('nematic', nematic);
window.addEventListener('hashchange', follow);
follow();
